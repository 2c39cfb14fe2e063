// House cleaning over Nav2: from room to room, in each room the tasks of that room, and to the dock whenever the battery is low.

{ include("$jacaros/artifacts.asl") }

place(0, 0, 0, 0).  // the hallway, the living room, the kitchen and the bathroom: metres, and degrees
place(1, 2, 0, 0).
place(2, 2, 2, 0).
place(3, 0, 2, 0).
place(dock, 1, 1, 0).
charged_at(100).  // percent
attempts(20).
arrives_within(0.05).  // metres
rounds(4).

!start.

+!start : rounds(N)
  <- !use_artifact("household", "ArtCleaning");
     !keep_charged |&| (!patrol([1, 2, 3, 0], N); .stopMAS).

// It could not charge, or has left out a room.
-!start[error_msg(Text)]
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit status reports the failure

+!arrived(0) <- .print("hallway").

+!arrived(Room)
  <- .print("room ", Room);
     +at_work(Room);
     clean(Room);
     -at_work(Room).

+!drive_into_dock <- !go_to(dock); .print("dock").

// What the battery has interrupted continues where it was.
+!drive_out_of_dock : at_work(Room)
  <- !go_to(Room).

+!drive_out_of_dock.

{ include("$jacaros/navigation.asl") }
