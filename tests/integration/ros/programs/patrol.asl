// Patrols four corners; at half charge it drives to its dock, charges, and continues to the same corner.
corner(0, 0, 0).
corner(1, 1, 0).
corner(2, 1, 1).
corner(3, 0, 1).

!begin.

+!begin
  <- makeArtifact("Wheels", "ArtCmdVel", [turn_speed(120)]);
     makeArtifact("Battery", "ArtSimBattery", [source(robot)], Battery);
     focus(Battery);
     !patrol(1).

+!patrol(Corner) : corner(Corner, X, Y)
  <- .print("heading for corner ", Corner);
     driveTo(X, Y);
     .print("reached corner ", Corner);
     !!patrol((Corner + 1) mod 4).

+battery(Level) : Level <= 50 & not charging & .intend(patrol(_))
  <- +charging;
     .suspend(patrol(_));
     .print("going to the dock with ", Level, " percent");
     driveTo(0.5, 0.5);
     operationRecharge;
     .print("charged");
     -charging;
     .resume(patrol(_)).
