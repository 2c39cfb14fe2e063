// One belief after another gets $k annotations.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     for (.range(B, 1, $n)) { for (.range(I, 1, $k)) { +seen(B)[time(I)] } };
     .print("end");
     .abolish(seen(_));
     !repeat(R - 1).
