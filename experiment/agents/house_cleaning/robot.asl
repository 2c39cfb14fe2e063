// House cleaning over Nav2: from room to room, in each room the tasks of that room, and to the dock whenever the battery is low.

{ include("$jacaros/artifacts.asl") }

place(0, 0, 0, 0).  // the hallway, the living room, the kitchen and the bathroom: metres, and degrees
place(1, 2, 0, 0).
place(2, 2, 2, 0).
place(3, 0, 2, 0).
place(dock, 1, 1, 0).
charged_at(100).  // percent
attempts(5).
rounds(4).

!start.

+!start : rounds(N)
  <- !use_artifact("household", "ArtCleaning");
     !!keep_charged;
     !patrol([1, 2, 3, 0], N);
     .stopMAS.

+!arrived(0).

// After an interruption, the robot goes back into the room before it goes on.
+!arrived(Room)
  <- clean(Room).

^!arrived(Room)[state(resumed)]
  <- !go_to(Room).

+!drive_into_dock
  <- !go_to(dock).

+!drive_out_of_dock.

{ include("$jacaros/navigation.asl") }
