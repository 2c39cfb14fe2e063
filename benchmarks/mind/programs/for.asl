// A loop over numbers, and a little arithmetic.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     for (.range(I, 1, $n)) { Y = I * 2 + 1 - I };
     .print("end");
     !repeat(R - 1).
