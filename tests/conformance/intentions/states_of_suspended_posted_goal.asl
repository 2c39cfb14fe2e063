// A goal that is resumed before it began is pending again.
!start.
+!start <- !!a; .wait(40); .suspend(a); .wait(40); .resume(a); .wait(80); !!c; .suspend(c); .wait(40); .resume(c); .wait(40); .stopMAS.
+!a <- .wait(100); .print(a2).
+!c <- .print(c).
^!a[state(S)[reason(R)]] : S \== pending & not .substring("wait",R) <- .print("a ",S," ",R).
^!c[state(S)[reason(R)]] <- .print("c ",S," ",R).
