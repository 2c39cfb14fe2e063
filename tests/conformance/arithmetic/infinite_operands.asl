// Operators with infinite operands and with NaN: as of Java's doubles; div rounds them to the largest integers.
i(1/0). m(-1/0). n(0/0).
!t.
+!t : i(I) & m(M) & n(N) <-
   .print("mod ", 7 mod I, " ", -7 mod I, " ", 7 mod M, " ", 0 mod I, " ", I mod 7, " ", M mod 7, " ", I mod I, " ", N mod 2);
   .print("power ", 1 ** I, " ", 1 ** M, " ", 1 ** N, " ", N ** 0, " ", I ** 0, " ", 2 ** I, " ", 2 ** M, " ", I ** -1, " ", 0 ** -1, " ", M ** 3, " ", M ** 2, " ", (-1) ** I, " ", (-8) ** 0.5);
   .print("sums ", I + M, " ", I - I, " ", I * 0, " ", I / I, " ", 0 / 0, " ", I * M, " ", -I, " ", N + 1);
   if (I > 1000) { .print(larger) }; if (N > 1) { .print(never) }; if (M < -1000) { .print(smaller) };
   .max([1,I,2],A); .min([1,M,2],B); .print(A, " ", B);
   .print("div ", I div 7, " ", M div 7, " ", 7 div I, " ", I div I);
   .stopMAS.
