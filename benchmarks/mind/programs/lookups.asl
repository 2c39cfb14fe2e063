// Beliefs are added, and each looked up by its first argument.
!start.
+!start <- !fill($n); !look($n); .stopMAS.
+!fill(0).
+!fill(I) : I > 0 <- +p(I, I * 2); !fill(I - 1).
+!look(0).
+!look(I) : p(I, V) & V == I * 2 <- !look(I - 1).
