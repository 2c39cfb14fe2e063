// The robot drives from place to place. When its battery is low, it charges first.

place(window, 3.2, 2.2).  // x and y in metres
place(table, 3.2, 0.6).
place(door, 0.6, 2.2).
place(dock, 0.6, 0.6).  // where the robot starts

!start.

+!start
  <- makeArtifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map)], Wheels);
     focus(Wheels);
     makeArtifact("battery", "ArtSimBattery", [source(robot)], Battery);
     focus(Battery);
     !tour.

+!tour
  <- for (.member(Place, [window, table, door])) { !visit(Place) };
     !tour.

+!visit(Place) : place(Place, X, Y)
  <- driveTo(X, Y);
     .print("at the ", Place).

// The way is blocked, for example: report it, and continue with the next place.
-!visit(Place)[error_msg(Why)]
  <- .print("cannot reach the ", Place, ": ", Why);
     .wait(1000).

// This plan interrupts the tour, which continues when the battery is full: it needs the wheels until then.
@charge[urgency(10), needs(wheels)]
+diagnostics("Low Battery") : place(dock, X, Y)
  <- .print("battery low");
     driveTo(X, Y);
     operationRecharge;
     .print("battery full").
