// Patrol: drive from corner to corner for a whole shift.  When the battery is low, recharge in the dock, then
// continue to the same corner.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

place(1, 2, 0, 0).  // number of the corner, x and y in metres, yaw in degrees
place(2, 2, 2, 90).
place(3, 0, 2, 180).
place(4, 0, 0, 270).  // where the robot starts
place(dock, 1, 1, 0).
visits_within(0.1).  // metres from a corner
shift(10).           // number of recharges in a shift

next(1).    // the corner that the robot is heading for
visits(0).  // number of corners reached
recharges(0).
lowest(100).  // lowest battery level on arrival in the dock, in percent

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map), stop_for(scan)]);
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !!patrol([1, 2, 3, 4]).  // !! : a separate goal, which runs independently of this one

/* The patrol: its plans are in a library, included at the end; these plans override some of its steps */

// Go to a place: drive straight there, in any final heading.
+!drive_there(X, Y, _)
  <- driveTo(X, Y).  // the plan waits here until the robot has arrived

// Of several plans for a goal, the agent selects the first whose context (after the colon) holds.
+!arrived(Corner) : visits(V)
  <- .print("round ", V div 4 + 1, ", corner ", Corner);
     -+visits(V + 1);  // -+ : replace the old belief by this one
     -+next(Corner mod 4 + 1);
     !end_of_shift.

+!end_of_shift : recharges(N) & shift(N) & .count(unreachable(_, _), Missing)
  <- !report;
     .stopMAS(0, Missing).  // the exit status: corners that were left out and not reached again

+!end_of_shift.

/* The battery */

// An agent can pursue several goals at the same time. This plan is more urgent than the patrol, and the library's
// charge_first needs the same wheels: the robot stops immediately, and when that goal has ended, driveTo continues to the
// same corner.
@charge[urgency(10)]
+diagnostics("Low Battery") : next(Corner) & not .intend(recharge)
  <- .print("battery low on the way to corner ", Corner);
     !recharge;
     .print("battery full, on to corner ", Corner).

+!recharge
  <- !charge_first[achieves(battery(Full) & Full > 95)].

// The robot could not charge, and no help has come.
-!recharge[error_msg(Text)]
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit status reports the failure

// The steps of the library's dock_and_charge: into the dock, charge, and out of the dock (nothing to do here).
+!drive_into_dock
  <- !go_to(dock).

+!wait_until_charged : recharges(N)
  <- ?battery(Percent);  // ? : query a belief
     !remember(Percent);
     .print("recharge ", N + 1, ", with ", Percent, " % left");
     operationRecharge;  // waits until the battery is full
     -+recharges(N + 1).

+!drive_out_of_dock.

+!remember(Percent) : lowest(Least) & Percent < Least
  <- -+lowest(Percent).

+!remember(_).

/* The end of the shift */

+!report : visits(Corners) & recharges(N) & lowest(Least)
  <- .print("----------------------------------------------------------------");
     .print("The shift is over, and all is quiet.");
     .print(Corners, " corners, that is ", Corners div 4, " rounds and ", Corners mod 4,
            " of the next");
     .print(N, " recharges, and never less than ", Least, " % in the battery");
     .print("----------------------------------------------------------------").

// Plans before this line take precedence over those of the library.
{ include("$jacaros/navigation.asl") }
