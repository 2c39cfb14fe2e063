// Beliefs with a variable are added, found and deleted again.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     for (.range(I, 1, $n)) { +likes(I, _) };
     for (.range(I, 1, $n)) { ?likes(I, beer) };
     for (.range(I, 1, $n)) { -likes(I, _) };
     .print("end");
     !repeat(R - 1).
