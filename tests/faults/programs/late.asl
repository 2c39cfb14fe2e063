// Drives one metre and turns left, each once: whatever fails ends the run.
!start.

+!start
  <- makeArtifact("wheels", "ArtCmdVelAndOdometry", [], Id);
     focus(Id);
     moveForward(1);
     .print("forward");
     rotate(90);
     .print("turned");
     .stopMAS.
