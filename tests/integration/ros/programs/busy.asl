// Takes longer to think about a place than the next one takes to come; tells each that it has thought about.
!begin.

+!begin
  <- makeArtifact("odometry", "ArtOdometry", [topic(fast_odom)], Id);
     focus(Id);
     .print("listening").

+pose(X, _, _)
  <- for (.range(I, 1, 20000)) { _Y = I };
     answer(X).
