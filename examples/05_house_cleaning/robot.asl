// House cleaning: from room to room, in each room the tasks of that room; when the battery is low, even in the
// middle of a task, to the dock, back into the room, and on.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

room(0, hallway, 0, 0).  // number, name, and where to go, in metres
room(1, living_room, 2, 0).
room(2, kitchen, 2, 2).
room(3, bathroom, 0, 2).
dock(1, 1).
rounds(4).  // so often the house is cleaned

done(0).  // rounds done
recharges(0).

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map)]);
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !use_artifact("household", "ArtCleaning");
     !!clean_house.

/* From room to room */

// The household shows in atRoom(Number) which room is the present one; it begins in the hallway.
+!clean_house : done(N) & rounds(N) & recharges(R)
  <- .print("The house is clean: ", N, " rounds, the battery charged ", R, " times.");
     .stopMAS.

// A room needs the wheels from the way there to the last swing.
@room[needs(wheels)]
+!clean_house
  <- updateWhereAmI;  // the next room is the present one now
     ?atRoom(Number);
     ?room(Number, Room, X, Y);
     driveTo(X, Y);
     !clean_room(Number, Room);
     !!clean_house.

// The round ends in the hallway, where there is nothing to do.
+!clean_room(_, hallway) : done(N)
  <- -+done(N + 1);
     .print("hallway: round ", N + 1, " is done").

+!clean_room(Number, _)
  <- clean(Number);
     rotate(-5);
     rotate(10);
     rotate(-5).  // a little swing, as one does

// What `clean` does shows in these properties of the household; they are empty at the beginning.
+vacuum(Thing, Room) : Thing \== "" <- .print(Room, ": vacuum the ", Thing).
+mop(Thing, Room) : Thing \== "" <- .print(Room, ": mop the ", Thing).
+scrub(Thing, Room) : Thing \== "" <- .print(Room, ": scrub the ", Thing).

/* The battery */

// More urgent than the house, and in need of the same wheels: driving and cleaning wait until the robot is back.
@charge[urgency(10)]
+diagnostics("Low Battery")
  <- .print("battery low");
     !charge_and_return[needs(wheels)].

+!charge_and_return
  <- !recharge;
     .print("battery full");
     !return.

+!recharge : dock(X, Y) & recharges(N)
  <- driveTo(X, Y);
     operationRecharge;
     -+recharges(N + 1).

// Something went wrong: the robot missed the dock, or something stood in its way.
-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!clean_house[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit code tells that it went wrong

// Back to the room that it was in, or on its way to; perhaps it had just arrived.
+!return : atRoom(Number) & room(Number, Room, X, Y)
  <- .print("back to the ", Room);
     driveTo(X, Y).
