// A fork inside a loop: each round has variables of its own, in both branches and after they have joined.
p(1). p(2). p(3). q(_,a). q(_,b).
!t.
+!t <-
  for (p(X)) { { Y = X; .wait(10); .print(left, X, Y) |&| Z = X + 10; .wait(20); .print(right, Z) }; .print(round, X) };
  for (q(V,W)) { { V = W |&| .wait(10) }; .print(W); if (V = c) { .print(bound, V) } };
  -+k(0); while (k(N) & N < 2) { { .wait(10); M = N; .print(M) ||| .wait(50); .print(never) }; -+k(N+1) };
  .print(end); .stopMAS.
