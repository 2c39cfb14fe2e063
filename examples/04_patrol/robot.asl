// Patrol: from corner to corner for a whole shift; when the battery is low, to the dock, and then on to the
// corner that the robot was heading for.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

place(1, 2, 0, 0).  // number of a corner, and where it is: metres, and degrees
place(2, 2, 2, 90).
place(3, 0, 2, 180).
place(4, 0, 0, 270).  // where the robot stands at the beginning
place(dock, 1, 1, 0).
attempts(1).  // when a way is blocked it does not try again
shift(10).    // it ends after so many recharges

next(1).    // the corner that the robot is heading for
visits(0).  // corners reached
recharges(0).
lowest(100).  // percent, the least that it ever had in the dock

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map)]);
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !!patrol([1, 2, 3, 4]).  // !! : a goal of its own, apart from this one

/* The patrol: its plans stand in a library, included at the end; here is what this robot does in its own way */

// Going to a place: straight ahead, and without caring where it looks then.
+!drive_there(X, Y, _)
  <- driveTo(X, Y).  // this plan waits here until the robot has arrived

// Of several plans for a goal the first one is taken whose condition, behind the colon, holds.
+!arrived(Corner) : visits(V)
  <- .print("round ", V div 4 + 1, ", corner ", Corner);
     -+visits(V + 1);  // -+ : forget the old belief, have this one
     -+next(Corner mod 4 + 1);
     !end_of_shift.

// A corner that it cannot reach.
-!reach(_, _)[error_msg(Text)]
  <- !give_up(Text).

+!end_of_shift : recharges(N) & shift(N)
  <- !report;
     .stopMAS.

+!end_of_shift.

/* The battery */

// An agent can have several things in mind. This plan is more urgent than the patrol, and its goal needs the same wheels:
// the robot stops immediately, wherever it is, and when the goal has ended, driveTo continues to the same corner.
@charge[urgency(10)]
+diagnostics("Low Battery") : next(Corner)
  <- .print("battery low on the way to corner ", Corner);
     !dock_and_charge[needs(wheels)];
     .print("battery full, on to corner ", Corner).

// The steps of the library's dock_and_charge: into the dock, wait there, and out of it, which needs nothing here.
+!drive_into_dock
  <- !go_to(dock).

+!wait_until_charged : recharges(N)
  <- ?battery(Percent);  // ? : what is it now?
     !remember(Percent);
     .print("recharge ", N + 1, ", with ", Percent, " % left");
     operationRecharge;  // waits until the battery is full
     -+recharges(N + 1).

+!drive_out_of_dock.

// Something went wrong: the robot missed the dock, or something stood in its way.
-!dock_and_charge[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit code tells that it went wrong

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

// Plans that stand before this line go before those of the library.
{ include("$jacaros/navigation.asl") }
