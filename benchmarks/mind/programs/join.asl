// A rule that joins two relations.
j(I, K) :- r(I, J) & s(J, K).
!start.
+!start <- !fill($n); !repeat($times).
+!fill(0) <- +s(0, 0).
+!fill(I) : I > 0 <- +r(I, I - 1); +s(I, I * 2); !fill(I - 1).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); .count(j(A, B), C); .print("end ", C); !repeat(R - 1).
