// Drives to a point and back by the robot's own navigation, retrying until it succeeds, and prints what it perceives.
!begin.

+!begin
  <- !there(2, 0);
     !there(0, 0);
     .stopMAS.

+!there(X, Y)
  <- navigate_to(X, Y);
     .print("at ", X, " ", Y).

-!there(X, Y)[error(E), env_failure_reason(Why)]
  <- .print(E, " ", Why);
     .wait(1000);
     !there(X, Y).

+connected(Topic) <- .print("connected ", Topic).
-connected(Topic) <- .print("lost ", Topic).
-pose(_) : not pose(_) <- .print("my pose is unknown").

+bad_message(Topic, Why) <- .print("bad ", Topic, " ", Why).
