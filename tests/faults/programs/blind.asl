// Drives by time alone, three times for two seconds, without odometry, and prints what it perceives.
!begin.

+!begin
  <- !drive(3);
     .wait(1000);
     .stopMAS.

+!drive(0).
+!drive(N)
  <- drive(0.3, 2);
     .print("driven");
     !drive(N - 1).

+odom(X, Y, F) <- .print("odom ", X, " ", F).
-odom(_, _, _) : not odom(_, _, _) <- .print("odom unknown").
+bad_message(Topic, Why) <- .print("bad ", Topic, " ", Why).
