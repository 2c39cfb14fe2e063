// Beliefs are added, each a new one.
!start.
+!start <- !fill($n); .stopMAS.
+!fill(0).
+!fill(I) : I > 0 <- +p(I, I * 2); !fill(I - 1).
