// Among $k beliefs, one is looked up by its first argument, again and again.
!start.
+!start <- !fill($k); !look($n); .stopMAS.
+!fill(0).
+!fill(I) : I > 0 <- +p(I, I * 2); !fill(I - 1).
+!look(0).
+!look(I) : K = I mod $k + 1 & p(K, V) & V == K * 2 <- !look(I - 1).
