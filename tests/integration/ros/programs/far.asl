// Drives three metres in one go: time enough to be ended in the middle.
!drive.

+!drive
  <- makeArtifact("Wheels", "ArtCmdVel");
     getCurrentPose(X, Y, _Heading);
     .print("standing at ", X, " ", Y);
     driveTo(3, 0);
     .print("arrived");
     .stopMAS.
