!go.
+!go <-
  makeArtifact("s","Sensor",[3],Id); focus(Id);
  .wait({+over}); ?level(N); .print("level ",N);
  .stopMAS.
+level(N) <- .print("+level ",N).
