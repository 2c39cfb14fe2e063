// Beliefs are put behind all others, and taken from the front, like jobs in a queue.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     for (.range(I, 1, $n)) { +> job(I) };
     for (.range(I, 1, $n)) { ?job(J); -job(J) };
     .print("end");
     !repeat(R - 1).
