// A sub-goal of a suspended intention that ends as failed is handled at once.
!start.
+!start <- !!a; .print(s0); .print(s1); .print(s2); .suspend(a); .print(susp); .fail_goal(b); .print(s4); .print(s5); .print(s6); .wait(40); .stopMAS.
+!a <- .print(a1); !b; .print(a2); .print(a3).
+!b <- for (.range(I,1,20)) { .print(b,I) }.
-!b <- .print(failed).
