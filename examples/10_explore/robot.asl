// Explores an unknown flat, then uses the map it made to drive to its goal and back home.

{ include("$jacaros/artifacts.asl") }
{ include("$jacaros/help.asl") }

/* What the agent knows */

goal_at(5.6, 4.1).           // metres east and north of where the robot starts
cell_size(0.1).              // metres
map_file("runs/flat.yaml").  // file to save the map to

!start[retry(6, 1000)].  // for a minute: what is in the way may go, or there may be a way round it

+!start : map_file(File)
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
     !use_map;
     !explore;
     saveMap(File);
     !go_to(goal);
     !go_to(home);
     .stopMAS.

// Failure: no path exists, or the robot cannot drive.  A person helps, or the run ends with exit status 1.
-!start[error_msg(Text)]
  <- !help_or_stop(Text);
     !start[retry(6, 1000)].

// The robot starts in cell 0, 0.
+!use_map : goal_at(X, Y) & cell_size(Size)
  <- !use_artifact("map", "ArtMap", [cell_size(Size)]);
     updateSlamData(0, 0, "home");
     updateSlamData(math.round(X / Size), math.round(Y / Size), "goal").

/* Exploring: drive to the frontier of the known area, until none is left */

+!explore
  <- getFrontier(X, Y);
     getRoute(X, Y);
     !drive_a_leg;  // what the robot sees on the way moves the frontier
     !explore.

-!explore[env_failure_reason(explored)]
  <- getDistance(Metres);
     .print("explored, after driving ", math.round(Metres), " m").

// Pass any other failure to the goal that posted this one.
-!explore[error_msg(Text)]
  <- .fail(error_msg(Text)).

/* Going to a place: leg by leg, because odometry drifts, and the map corrects it after each leg */

+!go_to(Place) : pos2d(Place, X, Y) & pos2d(me, X, Y)
  <- .print("at the place called ", Place).

+!go_to(Place) : pos2d(Place, X, Y)
  <- getRoute(X, Y);
     !drive_a_leg;
     !go_to(Place).

+!drive_a_leg
  <- getLeg(Degrees, Metres);
     rotate(Degrees);
     moveForward(Metres).
