// A goal that was suspended before it began is desired, not intended.
!start.
+!start <- !!a; .suspend(a); if (.suspended(a,R)) {.print(R)} else {.print("no reason")}; if (.intend(a)) {.print(intended)} else {.print("not intended")}; if (.desire(a)) {.print(desired)} else {.print("not desired")};
   .print(s1); .resume(a); .print(s2); .print(s3); .wait(40); .stopMAS.
+!a <- .print(a1).
