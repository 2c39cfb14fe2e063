// A goal whose last step suspends its intention is achieved after the resumption.
!start.
+!start <- !!a; .wait(50); .print(s1); .resume(b); .print(s2); .print(s3); .print(s4); .wait(40); .stopMAS.
+!a <- .print(a1); !b; .print(a2).
+!b <- .print(b1); .suspend(a).
