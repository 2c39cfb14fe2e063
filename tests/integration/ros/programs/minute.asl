// Waits for ten seconds of the run's clock.

!wait.

+!wait
  <- makeArtifact("ros", "ArtRos", [], Id);
     focus(Id);
     .print("waits");
     .wait(10000);
     .print("has waited");
     .stopMAS.

+clock_jumped(S)
  <- .print("jumped ", S).
