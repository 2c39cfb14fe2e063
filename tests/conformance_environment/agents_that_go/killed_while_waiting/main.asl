!go.
+!go <-
  makeArtifact("s","Shop",[],Id); focus(Id); .wait(100); .send(victim,achieve,work); .wait(100);
  ?waiting(W); .print("waiting ",W);
  .kill_agent(victim); .wait(60);
  put(1); .wait(60); stock(N); .print("in stock ",N);
  take(M); .print("took ",M);
  .create_agent(victim2,"heir.asl"); .wait(100); .stopMAS.
+sound(X) <- .print("sound ",X).
