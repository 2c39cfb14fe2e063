// One goal after the other: the call is the last formula, so the stack does not grow.
!start.
+!start <- !count($n); .stopMAS.
+!count(0).
+!count(I) : I > 0 <- !count(I - 1).
