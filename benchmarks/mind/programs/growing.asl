// A list in a belief grows by one element at a time, up to $k.
list([]).
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     for (.range(B, 1, $n)) {
         -+list([]);
         for (.range(I, 1, $k)) { ?list(L); .concat(L, [I], M); -+list(M) }
     };
     .print("end");
     !repeat(R - 1).
