// Drives ahead by time, and stops once its odometry, published at 1000 Hz, shows that it is far enough.
!begin.

+!begin
  <- makeArtifact("wheels", "ArtCmdVel", [odometry_topic(fast_odom)], _W);
     makeArtifact("odometry", "ArtOdometry", [topic(fast_odom)], O);
     focus(O);
     !!drive.

+!drive <- move(60).
-!drive[env_failure_reason(Why)] <- .print("stopped ", Why).

+pose(X, _, _) : X >= 1 & not stopped
  <- +stopped;
     ?thoughts(N);
     .print("seen at ", X, " after ", N, " thoughts");
     abortMoving.

// Its reasoning on the way takes longer than the interval between messages.
+pose(X, _, _) : X >= 0.9 & not stopped & thoughts(N)
  <- -+thoughts(N + 1);
     for (.range(I, 1, 20000)) { _Y = I }.

thoughts(0).
