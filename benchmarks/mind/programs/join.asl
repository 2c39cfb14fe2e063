// A rule that joins two relations.
j(I, K) :- r(I, J) & s(J, K).
!start.
+!start <- !fill($n); !ask; .stopMAS.
+!fill(0).
+!fill(I) : I > 0 <- +r(I, I - 1); +s(I, I * 2); !fill(I - 1).
+!ask : .count(j(A, B), C) & C == $n - 1.
