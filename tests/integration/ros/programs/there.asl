// Drives to a point by the robot's navigation, retrying until it succeeds, and prints what it perceives.
!begin.

+!begin
  <- .wait(connected("/odom"));
     !there(3, 0);
     .stopMAS.

+!there(X, Y)
  <- .print("on my way");
     navigate_to(X, Y, 0);
     .print("there").

-!there(X, Y)[error(E), env_failure_reason(Why)]
  <- .print(E, " ", Why);
     .wait(1000);
     !there(X, Y).

+connected(Topic) <- .print("connected ", Topic).
-connected(Topic) <- .print("lost ", Topic).
