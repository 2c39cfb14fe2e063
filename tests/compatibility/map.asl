// As chapter 9 and listing B.1: the cells in view are signalled one at a time, and objects have positions.
// jacaros: ignore-file singleton-variable

!start.

+!create_map
  <- makeArtifact("Slam_data", "jason.architecture.ArtSlamData", [], MapId).

+?toolMap(MapId)
  <- lookupArtifact("Slam_data", MapId).

+currentRange(X, Y, Label)
  <- .print(X, " ", Y, " ", Label).

+!start
  <- !create_map;
     ?toolMap(MapId);
     focus(MapId);
     updateSlamData(0, 0, "home");
     updateSlamData(0, 1, "free");
     updateSlamData(1, 0, "obstacle");
     updateSlamData(1, 1, "free");
     updateSlamData(2, 1, "goal");
     getVisionRange(0, 0, 1);
     !to_the_goal;
     .stopMAS.

+!to_the_goal : pos2d(me, X, Y) & pos2d(goal, X, Y)
  <- .print("at the goal").

+!to_the_goal
  <- getRoute;
     ?direction(Direction);
     ?degrees(Degrees);
     .print(Direction, ", turn ", Degrees);
     !go(Direction);
     !to_the_goal.

+!go(north) : true <- moveUp.

+!go(east) : true <- moveRight.
