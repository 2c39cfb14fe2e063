// Among $k beliefs, some are looked up by their first argument, here and there.
!start.
+!start <- !fill($k); !repeat($times).
+!fill(0).
+!fill(I) : I > 0 <- +p(I, I * 2); !fill(I - 1).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !look($n); .print("end"); !repeat(R - 1).
+!look(0).
+!look(I) : K = I * 7919 mod $k + 1 & p(K, V) & V == K * 2 <- !look(I - 1).
