// Drives one metre and turns left, each once: whatever fails ends the test.
!start.

+!start
  <- makeArtifact("wheels", "ArtCmdVelAndOdometry", [], Id);
     focus(Id);
     moveForward(1);
     .print("forward");
     rotate(90);
     .print("turned");
     .stopMAS.

-!start[env_failure_reason(Why), error_msg(Text)]
  <- .print(Why, " ", Text);
     .stopMAS(0, 1).
