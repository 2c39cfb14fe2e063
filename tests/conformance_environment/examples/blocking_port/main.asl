!go.
+!go <-
  makeArtifact("here","Port",[],Here); makeArtifact("there","Port",[],There); focus(Here); .wait(60);
  !!listen(Here); .wait(60); .print("sends");
  deliver("hello",7)[artifact_id(Here)]; .wait(60);
  deliver("early",1)[artifact_id(There)]; receive(T,N)[artifact_id(There)]; .print("at once ",T," ",N);
  .stopMAS.
+!listen(P) <- .print("listens"); receive(Text,N)[artifact_id(P)]; .print("received ",Text," ",N).
+state(S) <- .print("state ",S).
