// Drives away, half a minute long.
!drive.

+!drive
  <- makeArtifact("Wheels", "ArtCmdVel");
     moveForward(20).
