// Every odometry message becomes a command, through one plan.
!start.

+!start
  <- makeArtifact("odometry", "ArtOdometry", [], Odometry);
     makeArtifact("reply", "Reply", [], _);
     focus(Odometry);
     .print("listening").

+odom(Number, _, _) : Number > 0
  <- reply(Number).
