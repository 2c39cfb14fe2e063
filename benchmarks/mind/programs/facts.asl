// Beliefs are added, each a new one.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     !fill($n);
     .print("end");
     .abolish(p(_, _));
     !repeat(R - 1).
+!fill(0).
+!fill(I) : I > 0 <- +p(I, I * 2); !fill(I - 1).
