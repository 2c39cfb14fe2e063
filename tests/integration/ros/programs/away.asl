// Drives away for half a minute.
!drive.

+!drive
  <- makeArtifact("Wheels", "ArtCmdVel");
     moveForward(20).
