// Patrol: from corner to corner for a whole shift; when the battery is low, to the dock, and then on to the
// corner that the robot was heading for.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

corner(1, 2, 0).  // number, and place in metres
corner(2, 2, 2).
corner(3, 0, 2).
corner(4, 0, 0).  // where the robot stands at the beginning
dock(1, 1).
shift(10).  // it ends after so many recharges

next(1).    // the corner that the robot is heading for
visits(0).  // corners reached
recharges(0).
lowest(100).  // percent, the least that it ever had in the dock

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !!patrol.  // !! : a goal of its own, apart from this one

/* The patrol */

// Of several plans for a goal the first one is taken whose condition, behind the colon, holds.
+!patrol : recharges(N) & shift(N)
  <- !report;
     .stopMAS.

+!patrol : next(Corner) & corner(Corner, X, Y) & visits(V)
  <- driveTo(X, Y);  // this plan waits here until the robot has arrived
     .print("round ", V div 4 + 1, ", corner ", Corner);
     -+visits(V + 1);  // -+ : forget the old belief, have this one
     -+next(Corner mod 4 + 1);
     !!patrol.

/* The battery */

// This plan runs beside the patrol: an agent can have several things in mind.
+diagnostics("Low Battery") : next(Corner)
  <- .suspend(patrol);  // the robot stops at once, wherever it is
     .print("battery low on the way to corner ", Corner);
     !recharge;
     .print("battery full, on to corner ", Corner);
     .resume(patrol).  // driveTo goes on: from where the robot is now, to the same corner

+!recharge : dock(X, Y) & recharges(N)
  <- driveTo(X, Y);
     ?battery(Percent);  // ? : what is it now?
     !remember(Percent);
     .print("recharge ", N + 1, ", with ", Percent, " % left");
     operationRecharge;  // waits until the battery is full
     -+recharges(N + 1).

// Something went wrong: the robot missed the dock, or something stood in its way.
-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!patrol[error_msg(Text)]
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
