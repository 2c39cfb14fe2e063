// An intention that suspended itself goes on before the intention that resumes it.
!start.
+!start <- !!a; .wait(50); .print(s1); .resume(a); .print(s2); .print(s3); .print(s4); .wait(40); .stopMAS.
+!a <- .print(a1); .suspend(a); .print(a2); .print(a3); .print(a4).
