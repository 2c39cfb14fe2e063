// Drives ahead by time, and stops as soon as it sees that it is far enough; its odometry comes a thousand times a second.
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
     .print("seen at ", X);
     abortMoving.

+pose(X, _, _)
  <- for (.range(I, 1, 2000)) { _Y = I };
     -+thought(X).
