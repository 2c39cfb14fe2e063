// Each new belief is an event with a plan.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     !gen($n);
     .print("end");
     .abolish(b(_));
     !repeat(R - 1).
+!gen(0).
+!gen(I) : I > 0 <- +b(I); !gen(I - 1).
+b(X) : X > 0 <- Y = X + 1.
