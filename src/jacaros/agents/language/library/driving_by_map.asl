// Driving by the map of an ArtMap, without Nav2: the steps of $jacaros/navigation.asl that depend on how a robot drives.
// Include them before it:
//
//     { include("$jacaros/driving_by_map.asl") }
//     { include("$jacaros/navigation.asl") }
//
// The program makes the map and an artifact that drives, such as ArtCmdVel.  If the cells of the map are not 10 cm wide, say
//
//     cell_size(0.05).            // metres

map_cell(X, Y, Column, Row) :- cell_width(Size) & Column = math.round(X / Size) & Row = math.round(Y / Size).

cell_width(Size) :- cell_size(Size).
cell_width(0.1) :- not cell_size(_).

// Leg by leg: odometry drifts, and the map corrects it after each leg.
+!drive_there(X, Y, Yaw) : map_cell(X, Y, Column, Row) & pos2d(me, Column, Row)
  <- getPose(_, _, Now);
     !turn_on_the_spot(Yaw - Now - 360 * math.round((Yaw - Now) / 360)).

+!drive_there(X, Y, Yaw) : map_cell(X, Y, Column, Row)
  <- getRoute(Column, Row);
     !drive_leg;
     !drive_there(X, Y, Yaw).

+!drive_leg
  <- getLeg(Degrees, Metres);
     rotate(Degrees);
     moveForward(Metres).

+!turn_on_the_spot(Degrees)
  <- rotate(Degrees).

// Where the newest scan shows the longest way.
+!drive_to_open_ground : lost
  <- getOpenGround(Degrees, Metres);
     rotate(Degrees);
     moveForward(Metres).
