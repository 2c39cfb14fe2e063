// House cleaning: drive from room to room and do the tasks of each.  When the battery is low, even in the middle of
// a task, recharge in the dock, return to the room, and continue.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

room(0, hallway, 0, 0).  // number, name, x and y in metres
room(1, living_room, 2, 0).
room(2, kitchen, 2, 2).
room(3, bathroom, 0, 2).
dock(1, 1).
rounds(4).  // how often to clean the house

done(0).  // rounds completed
recharges(0).

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map)]);
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !use_artifact("household", "ArtCleaning");
     !!clean_house.

/* From room to room */

// The property atRoom(Number) of the household is the current room, at first the hallway.
+!clean_house : done(N) & rounds(N) & recharges(R)
  <- .print("The house is clean: ", N, " rounds, the battery charged ", R, " times.");
     .stopMAS.

// Cleaning a room needs the wheels, from the drive there to the last swing.
@room[needs(wheels)]
+!clean_house
  <- updateWhereAmI;  // make the next room the current one
     ?atRoom(Number);
     ?room(Number, Room, X, Y);
     driveTo(X, Y);
     !clean_room(Number, Room);
     !!clean_house.

// A round ends in the hallway, which has no tasks.
+!clean_room(_, hallway) : done(N)
  <- -+done(N + 1);
     .print("hallway: round ", N + 1, " is done").

+!clean_room(Number, _)
  <- clean(Number);
     rotate(-5);
     rotate(10);
     rotate(-5).  // a little swing

// `clean` sets these properties of the household to its current task; they are empty at first.
+vacuum(Thing, Room) : Thing \== "" <- .print(Room, ": vacuum the ", Thing).
+mop(Thing, Room) : Thing \== "" <- .print(Room, ": mop the ", Thing).
+scrub(Thing, Room) : Thing \== "" <- .print(Room, ": scrub the ", Thing).

/* The battery */

// More urgent than cleaning, and needs the same wheels: driving and cleaning wait until the robot is back.
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

// Failure: the robot missed the dock, or its path was blocked.
-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!clean_house[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit status reports the failure

// Back to the room that the robot was in or heading for.
+!return : atRoom(Number) & room(Number, Room, X, Y)
  <- .print("back to the ", Room);
     driveTo(X, Y).
