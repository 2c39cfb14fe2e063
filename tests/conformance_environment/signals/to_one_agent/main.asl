!go.
+!go <-
  makeArtifact("b","Bell",[],Id); focus(Id); .send(bob,achieve,watch); .wait(100);
  ring_for("bob"); .wait(50);
  ring_for("nobody"); .wait(50);
  ?rung(N); .print("rung ",N);
  .send(bob,achieve,tell); .wait(100);
  .stopMAS.
+ring(N) <- .print("ring ",N).
+rung(N) <- .print("+rung ",N).
