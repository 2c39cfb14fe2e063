// The variables that a condition of `while` binds are free again in the next round, and bound in the body.
k(0). p(1,a). p(2,b). p(3,c).
!t.
+!t <-
   while (k(N) & N < 3) { .print(N); -+k(N+1) };
   while (p(I,V) & not done(I)) { .print(I, V); +done(I); W = V; .print(W) };
   .print(N, " ", V);
   L = f(A,B); while (k(B) & B < 5) { A = B; .print(L); -+k(B+1) }; .print(L);
   ?k(Q); while (k(Q)) { .print(still, Q); -+k(9) }; .print(end, Q);
   for (p(X,Y) & X > 1) { .print(X, Y); if (p(Z,b) & Z == X) { .print(found, Z) } }; .print(Z);
   .stopMAS.
