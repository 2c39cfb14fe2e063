// An internal action that waits is no condition: a rule that asks it does not hold.
slow :- .wait(10).
!start.
+!start
  <- if (slow) { .print(yes) } else { .print(no) };
     .stopMAS.
