// Explores a flat that it does not know, drives to its goal by the map that it made, and back home.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

goal_at(5.6, 4.1).           // metres to the east and to the north of where the robot begins
cell_size(0.1).              // metres
map_file("runs/flat.yaml").  // where the map is saved

!start.

+!start : map_file(File)
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
     !use_map;
     !explore;
     saveMap(File);
     !go_to(goal);
     !go_to(home);
     .stopMAS.

// Something went wrong: there is no way, or the robot cannot drive.
-!start[error_msg(Text)]
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).

// The cell in which the robot begins is 0, 0.
+!use_map : goal_at(X, Y) & cell_size(Size)
  <- !use_artifact("map", "ArtMap", [cell_size(Size)]);
     updateSlamData(0, 0, "home");
     updateSlamData(math.round(X / Size), math.round(Y / Size), "goal").

/* Exploring: to where the known ground ends, until there is no such place */

+!explore
  <- getFrontier(X, Y);
     getRoute(X, Y);
     !drive_a_leg;  // what is seen on the way changes where the known ground ends
     !explore.

-!explore[env_failure_reason(explored)]
  <- getDistance(Metres);
     .print("explored, on a way of ", math.round(Metres), " m").

// Any other reason is for the goal that wanted this.
-!explore[error_msg(Text)]
  <- .fail(error_msg(Text)).

/* Going to a place: leg by leg, because odometry goes wrong, and the map puts it right after each */

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
