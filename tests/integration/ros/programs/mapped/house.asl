// Drives, perceives and navigates with a mapping only, and ends with a goal that no robot can reach.

!start.

+!start
  <- .wait(odom(_, _, _) & battery(_, _) & connected("/odom"));
     ?odom(X, Y, _);
     drive(0.3, 0, 2);
     .wait(odom(X1, Y1, _) & (X1 - X) * (X1 - X) + (Y1 - Y) * (Y1 - Y) > 0.09);
     .print("driven");
     .wait(laserrange(_, _, _, _, _));
     look;
     .wait(scan(_));
     .print("seen");
     navigate_to(X, Y, 0);
     .print("back");
     navigate_to(1000, 0, 0).

+at(_, _) : not on_the_way
  <- +on_the_way;
     .print("on the way").

-!start[env_failure_reason(aborted(_, _))]
  <- .print("out of reach");
     .stopMAS.

-!start[env_failure_reason(rejected)]
  <- .print("out of reach");
     .stopMAS.
