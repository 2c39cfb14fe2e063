// As the looked-up facts, in a namespace.
!start.
+!start <- !fill($n); !look($n); .stopMAS.
+!fill(0).
+!fill(I) : I > 0 <- +map::p(I, I * 2); !fill(I - 1).
+!look(0).
+!look(I) : map::p(I, V) & V == I * 2 <- !look(I - 1).
