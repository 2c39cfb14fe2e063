// An internal action cannot be tested like a goal.
!start.
+!start <- .member(X,[1]);
  ?.member(Y,[2]); .stopMAS.
