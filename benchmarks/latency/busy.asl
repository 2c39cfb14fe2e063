// As echo.asl, but the plan is urgent, and beside it 100 intentions never rest.
!start.

+!start
  <- makeArtifact("odometry", "ArtOdometry", [], Odometry);
     makeArtifact("reply", "Reply", [], _);
     focus(Odometry);
     for (.range(I, 1, 100)) {
        !!work(I, 0);
     };
     .print("listening").

@answer[urgency(10)]
+odom(Number, _, _) : Number > 0
  <- reply(Number).

+!work(I, N)
  <- -+state(I, N);
     !work(I, (N * 7 + I) mod 1000).  // jacaros: ignore loop-without-wait (busy on purpose)
