// House cleaning: drive from room to room and do the tasks of each.  When the battery is low, even in the middle of
// a task, recharge in the dock, return to the room, and continue.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

room(0, hallway).
room(1, living_room).
room(2, kitchen).
room(3, bathroom).
place(0, 0, 0, 0).  // number of the room, x and y in metres, yaw in degrees
place(1, 2, 0, 0).
place(2, 2, 2, 0).
place(3, 0, 2, 0).
place(dock, 1, 1, 0).
attempts(20).  // so long a door may stay closed
rounds(4).     // how often to clean the house

done(0).  // rounds completed
recharges(0).

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map), stop_for(scan)]);
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !use_artifact("household", "ArtCleaning");
     !!clean_house.

/* From room to room: go_to is a plan of the library that is included at the end */

// Go to a place: drive straight there, in any final heading.
+!drive_there(X, Y, _)
  <- driveTo(X, Y).

// Something is in the way, such as a closed door: wait, and try again.
+!recover(blocked(_)) : atRoom(Number) & room(Number, Room)
  <- .print("I need help, or time: something is in my way to the ", Room);
     .wait(3000).

// The property atRoom(Number) of the household is the current room, at first the hallway.
+!clean_house : done(N) & rounds(N) & recharges(R)
  <- .print("The house is clean: ", N, " rounds, the battery charged ", R, " times.");
     .stopMAS.

// Cleaning a room needs the wheels, from the drive there to the last swing.
@room[needs(wheels)]
+!clean_house
  <- updateWhereAmI;  // make the next room the current one
     ?atRoom(Number);
     ?room(Number, Room);
     !go_to(Number);
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

+!recharge
  <- !charge_first[achieves(battery(Full) & Full > 95)].

// The steps of the library's charge_first: into the dock, charge, and out of the dock (nothing to do here).
+!drive_into_dock
  <- !go_to(dock).

+!wait_until_charged : recharges(N)
  <- operationRecharge;  // waits until the battery is full
     -+recharges(N + 1).

+!drive_out_of_dock.

// Failure: the robot could not charge, or not get to a room, and no help has come.
-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!clean_house[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit status reports the failure

// Back to the room that the robot was in or heading for.
+!return : atRoom(Number) & room(Number, Room)
  <- .print("back to the ", Room);
     !go_to(Number).

// A robot that was lost also returns there.
+!return_to_work
  <- !return.

// Plans before this line take precedence over those of the library.
{ include("$jacaros/navigation.asl") }
