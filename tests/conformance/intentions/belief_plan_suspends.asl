// A plan for an own belief change suspends the intention that made it.
!start.
+!start <- !!a; !!b; .wait(60); .print("end"); .stopMAS.
+!a <- .print("a1"); +x(1); .print("a2"); .print("a3").
+x(N) <- .print("x ", N); .suspend(a); .print("x after suspend").
+!b <- .print("b1"); .print("b2"); .wait(20); .resume(a); .print("b3").
