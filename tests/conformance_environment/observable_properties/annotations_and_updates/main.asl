!go.
+!go <-
  makeArtifact("d","Door",[],Id); focus(Id); .wait(20);
  ?door(S)[since(T)]; .print(S," since ",T);
  mark(locked); .wait(20);
  ?door(S2)[note(N)]; .print(S2," ",N);
  set(open); .wait(20);
  ?door(S3)[since(T3),note(N3)]; .print(S3," since ",T3," ",N3);
  .stopMAS.
+door(S)[artifact_name(A)] <- .print("+door ",S," of ",A).
-door(S) <- .print("-door ",S).
