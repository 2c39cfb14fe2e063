// Drives to a point by odometry and back, retrying until it succeeds, and prints what it perceives.
!begin.

+!begin
  <- makeArtifact("wheels", "ArtCmdVelAndOdometry", [mode(verbose), rate(2), watch_connection(1)],
                  Id);
     focus(Id);
     !there(2, 0);
     !there(0, 0);
     .stopMAS.

+!there(X, Y)
  <- driveTo(X, Y);
     .print("at ", X, " ", Y).

-!there(X, Y)[error(E), env_failure_reason(Why)]
  <- .print(E, " ", Why);
     .wait(1000);
     !there(X, Y).

+connected(Topic) <- .print("connected ", Topic).
-connected(Topic) <- .print("lost ", Topic).

+bad_message(Topic, Why) <- .print("bad ", Topic, " ", Why).
