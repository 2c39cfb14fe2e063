// Patrol over Nav2: from corner to corner for a whole shift, and to the dock whenever the battery is low.

place(1, 2, 0, 0).  // number of a corner, and where it is: metres, and degrees
place(2, 2, 2, 90).
place(3, 0, 2, 180).
place(4, 0, 0, 270).
place(dock, 1, 1, 0).
charged_at(100).  // percent
attempts(20).
visits_within(0.1).  // metres
shift(10).           // it ends after so many recharges
recharges(0).

!keep_charged.
!patrol([1, 2, 3, 4]).

// The exit status is the number of corners that were left out and not reached again.
+!arrived(Corner) : shift(N) & recharges(N) & .count(unreachable(_, _), Missing)
  <- .print("corner ", Corner);
     .stopMAS(0, Missing).

+!arrived(Corner) <- .print("corner ", Corner).

-!keep_charged <- .stopMAS(0, 1).

// The dock charges a robot that stands in it: no need to drive in and out.
+!drive_into_dock <- !go_to(dock); .print("dock").

+!drive_out_of_dock : battery_full & recharges(N) <- -+recharges(N + 1).

{ include("$jacaros/navigation.asl") }
