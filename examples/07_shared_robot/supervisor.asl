// The supervisor lets the driver patrol, takes the robot when the battery is low, and ends the shift.

/* What the agent knows */

dock(1, 1).  // x and y in metres
home(0, 0).
rounds(4).  // number of rounds in a shift
recharges(0).

/* The battery */

+diagnostics("Low Battery") : battery(Percent)
  <- .print("I want the robot: ", Percent, " % left, enough to reach the dock");
     !recharge.

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
     !finish.

+!finish : home(X, Y) & rounds(N) & recharges(R)
  <- take_over;
     driveTo(X, Y)[artifact_name("wheels")];
     .print("the robot is at home: ", N, " rounds, ", R, " recharges");
     .stopMAS.

/* Failures: the robot missed the dock, or its path was blocked */

-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!finish[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit status reports the failure
