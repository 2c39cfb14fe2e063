!go.
+!go <-
  makeArtifact("l","cartago.tools.Latch",[]);
  !!pass(1); .wait(100); .print("held"); set; .print("set"); .wait(100); !pass(2);
  .stopMAS.
+!pass(N) <- waitForSet; .print("passed ",N).
