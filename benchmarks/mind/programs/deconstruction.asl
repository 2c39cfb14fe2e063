// Structures are taken apart, and made from their parts.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !loop($n); .print("end"); !repeat(R - 1).
+!loop(0).
+!loop(I) : I > 0 <- p(I, dock, [b, c]) =.. [F, A, B]; Q =.. [q, A, B]; !loop(I - 1).
