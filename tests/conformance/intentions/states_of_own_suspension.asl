// A goal that suspends itself is resumed, and then executing.
!start.
+!start <- !!a; .wait(40); .resume(a); .wait(80); .stopMAS.
+!a <- .suspend; .print(a2).
^!a[state(S)[reason(R)]] <- .print("a ",S," ",R).
