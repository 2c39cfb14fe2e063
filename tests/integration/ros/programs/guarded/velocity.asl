// Drives by velocity commands, for longer than any test takes, and prints what interrupted it.
!drive.

+!drive
  <- makeArtifact("wheels", "ArtCmdVel", [], Id);
     focus(Id);
     moveForward(38).

+motion_interrupted(Why) <- .print("interrupted ", Why).
