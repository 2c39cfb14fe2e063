// A loop that replaces a belief in each round.
x(0).
!start.
+!start <- while (x(I) & I < $n) { -+x(I + 1) }; .stopMAS.
