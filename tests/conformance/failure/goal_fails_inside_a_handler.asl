// A goal inside a failure plan fails: the next goal down the stack that has a failure plan handles it.
!t.
+!t <- !a(1); .print(t1); !a(2); .print(never).
-!t <- .print(ht); !a(3); .print(t2); .stopMAS.
+!a(N) <- !b(N); .print(b_achieved, N).
+!b(N) <- !c(N); .print(c_achieved, N).
+!c(3) <- .print(c3).
+!c(N) <- .print(c, N); .fail.
-!c(N) <- .print(hc, N); !d(N); .print(never).
+!d(N) <- .print(d, N); .fail.
-!b(1) <- .print(hb1).
-!b(2) <- .print(hb2); !c(2); .print(never).
