!go.
+!go <-
  makeArtifact("m","Meeting",[],Id); focus(Id); .wait(60);
  !!first; .wait(60); !!second; .wait(60);
  come(1); .wait(60); come(1); .wait(60); .print("the end"); .stopMAS.
+!first <- .print("first asks"); meet(first,2,N); .print("first has ",N).
+!second <- .print("second asks"); meet(second,1,N); .print("second has ",N).
+phase(Who,What) <- .print(Who," ",What).
