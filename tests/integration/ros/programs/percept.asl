// Drives far away as soon as it perceives its battery level.
!begin.

+!begin
  <- makeArtifact("Wheels", "ArtCmdVel", []);
     makeArtifact("Battery", "ArtSimBattery", [source(robot)], Battery);
     focus(Battery).

+battery(_) : not away
  <- +away;
     driveTo(3, 0).
