// Drives, waits, and calls a server that never answers, at the same time, and prints how long each took.
!begin.

+!begin
  <- makeArtifact("wheels", "ArtCmdVelAndOdometry", [watch_connection(1)], W);
     makeArtifact("battery", "ArtSimBattery", [drain(10)], B);
     makeArtifact("ros", "ArtRos", [], R);
     focus(W);
     focus(B);
     focus(R);
     !!drive;
     !!wait;
     !!ask;
     !!hurry.

+!drive <- driveTo(2, 0); .print("arrived"); +arrived.
-!drive[env_failure_reason(Why)] <- .print("drive ", Why).

+!wait <- .wait(8000); .print("waited").

+!ask <- open_gripper.
-!ask[env_failure_reason(Why)] <- .print(Why).

+!hurry <- .wait({ +never }, 7000).
-!hurry[error(E)] <- .print(E).

+battery(50) <- .print("half empty").
+clock_jumped(S) <- .print("the clock jumped back by ", math.round(S), " s").
+connected(Topic) <- .print("connected ", Topic).
-connected(Topic) <- .print("lost ", Topic).
+bad_message(Topic, Why) <- .print("bad ", Topic, " ", Why).
