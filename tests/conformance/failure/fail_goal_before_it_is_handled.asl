// `.fail_goal` of goals that no plan has handled yet: their failure plans run.
!t.
@t[atomic] +!t <- !!x(1); !!y; !!x(2); .fail_goal(x(_)); .print(t).
+!x(N) <- .print(never, N).
-!x(N) <- .print(failed, N).
+!y <- .wait(50); .stopMAS.
