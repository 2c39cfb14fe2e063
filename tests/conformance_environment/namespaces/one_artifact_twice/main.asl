!go.
+!go <-
  makeArtifact("a","Counter",[1],A); makeArtifact("b","Counter",[10],B);
  left::focus(A); right::focus(B); both::focus(A); .wait(60);
  ?left::count(X); ?right::count(Y); ?both::count(Z); .print(X," ",Y," ",Z);
  .count(count(_),N); .print("in no namespace: ",N);
  right::inc; .wait(60); left::inc; .wait(60); inc; .wait(60);
  left::stopFocus(A); .wait(60); left::inc; .wait(60); stopFocus(A);
  .count(left::count(_),N1); .count(both::count(_),N2); .count(right::count(_),N3); .print(N1," ",N2," ",N3);
  right::inc; .wait(60); ?right::count(Y2); .print(Y2); .stopMAS.
+left::count(N) <- .print("left ",N).
+right::count(N) <- .print("right ",N).
+both::count(N) <- .print("both ",N).
+left::tick(N) <- .print("left tick ",N).
+right::tick(N) <- .print("right tick ",N).
+tick(N) <- .print("tick ",N).
