// A loop that replaces a belief in each turn.
x(0).
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     while (x(I) & I < $n) { -+x(I + 1) };
     ?x(X);
     .print("end ", X);
     -+x(X - X);
     !repeat(R - 1).
