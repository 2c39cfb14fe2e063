// One goal after the other: the call is the last formula, so the stack does not grow.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !count($n); .print("end"); !repeat(R - 1).
+!count(0).
+!count(I) : I > 0 <- !count(I - 1).
