// The supervisor lets the driver patrol, takes the robot when the battery is low, and ends the shift.

{ include("$jacaros/help.asl") }

/* What the agent knows */

dock(1, 1).  // x and y in metres
home(0, 0).
rounds(4).  // number of rounds in a shift
recharges(0).

/* The battery */

+diagnostics("Low Battery") : battery(Percent)
  <- .print("I want the robot: ", Percent, " % left, enough to reach the dock");
     !recharge[retry(6, 1000)].  // a minute: what is in the way may go

+!recharge : dock(X, Y) & recharges(N)
  <- take_over;  // the plan waits here until the driver has released the robot
     driveTo(X, Y)[artifact_name("wheels")];
     ?battery(Percent);  // ? : query a belief
     .print("recharge ", N + 1, ", with ", Percent, " % left");
     operationRecharge;
     -+recharges(N + 1);
     hand_over;
     .print("the battery is full, the driver may have the robot").

/* The end of the shift */

+visits(Corners) : rounds(N) & Corners == 4 * N
  <- .print("I want the robot: the shift is over");
     !finish[retry(6, 1000)].

+!finish : home(X, Y) & rounds(N) & recharges(R)
  <- take_over;
     driveTo(X, Y)[artifact_name("wheels")];
     .print("the robot is at home: ", N, " rounds, ", R, " recharges");
     .stopMAS.

/* Failures: the robot missed the dock, or its path is blocked; a person helps, or the run ends with exit status 1 */

-!recharge[error_msg(Text)]
  <- !help_or_stop(Text);
     !recharge.

-!finish[error_msg(Text)]
  <- !help_or_stop(Text);
     !finish.
