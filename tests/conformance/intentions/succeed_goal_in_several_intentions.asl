// `.succeed_goal` ends the goal in all intentions, also where it has branches of a fork.
!a. !b. !t.
+!a <- !x(1); .print(a).
+!b <- !x(2); .wait(50); .print(b).
+!x(N) <- .print(x,N); { .wait(500); .print(never) |&| .wait(600); .print(never) }; .print(never).
+!t <- .wait(50); .succeed_goal(x(_)); .wait(100); .print(end); .stopMAS.
