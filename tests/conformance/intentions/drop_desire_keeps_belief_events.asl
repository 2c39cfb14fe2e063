// `.drop_desire` drops goals only: the event of an equal belief is handled.
!t.
@t[atomic] +!t <- ++e(1); !!e(1); !!e(2); .drop_desire(e(1)); .print(dropped); !!end.
+e(X) <- .print(belief, X).
+!e(X) <- .print(goal, X).
+!end <- .wait(50); .stopMAS.
