// Control statements may be written as the internal actions that they are compiled to.
p(1). p(2).
!start.
+!start
  <- .foreach(p(X), { .print(X) });
     .if_then_else(p(3), { .print(yes) }, { .print(no) });
     .if_then_else(p(1), { .print(yes) });
     .stopMAS.
