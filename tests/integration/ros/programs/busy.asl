// Takes longer to handle a position than the next one takes to arrive, and reports each position that it has handled.
!begin.

+!begin
  <- makeArtifact("odometry", "ArtOdometry", [topic(fast_odom)], Id);
     focus(Id);
     .print("listening").

+pose(X, _, _)
  <- for (.range(I, 1, 20000)) { _Y = I };
     answer(X).
