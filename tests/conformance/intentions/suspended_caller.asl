// Suspending a goal suspends the sub-goal that does it.
!start.
+!start <- !!r; !a; .print(end); .stopMAS.
+!a <- .print(a1); !b; .print(a2).
+!b <- .print(b1); .suspend(start); .print(b2).
+!r <- .wait(60); .print(r1); if (.suspended(start,R)) {.print(R)}; if (.intend(b)) {.print(i)} else {.print("not i")}; .resume(b); .print(r2); .print(r3).
