// Loops of $k rounds, each of which forks into two branches and joins them.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !loop($n); .print("end"); !repeat(R - 1).
+!loop(0).
+!loop(N) : N > 0 <- for (.range(I, 1, $k)) { X = I |&| Y = I + 1 }; !loop(N - 1).
