// Beliefs are added, and each looked up by its first argument.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     !fill($n);
     !look($n);
     .print("end");
     .abolish(p(_, _));
     !repeat(R - 1).
+!fill(0).
+!fill(I) : I > 0 <- +p(I, I * 2); !fill(I - 1).
+!look(0).
+!look(I) : p(I, V) & V == I * 2 <- !look(I - 1).
