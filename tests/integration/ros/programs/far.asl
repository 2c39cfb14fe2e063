// Drives three metres in one go: long enough to be interrupted on the way.
!drive.

+!drive
  <- makeArtifact("Wheels", "ArtCmdVel");
     getCurrentPose(X, Y, _Heading);
     .print("standing at ", X, " ", Y);
     driveTo(3, 0);
     .print("arrived");
     .stopMAS.
