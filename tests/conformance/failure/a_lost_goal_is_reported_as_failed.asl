// The state of a goal that fails without a plan for it is reported to plans, then that it is over.
!s.
+!s <- !!g; .wait(50); .stopMAS.
+!g <- .print(g); .fail.
^!g[state(failed)[reason(R)]] <- .print(failed(R)).
^!g[state(finished)] <- .print(finished).
