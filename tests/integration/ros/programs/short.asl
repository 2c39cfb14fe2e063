// Drives half a metre as soon as a robot is present.
!drive.

+!drive
  <- .print("begins");
     makeArtifact("Wheels", "ArtCmdVel", [odometry_timeout(60)]);
     moveForward(0.5);
     .print("arrived");
     .stopMAS.
