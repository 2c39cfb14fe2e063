// Beliefs whose arguments have annotations: equal ones are merged, others are beliefs of their own.
!t.
+!t <- +p(a[x]); +p(b[y]); +p(a[x]); .findall(X, p(X), L); .print(L);
  +p(a[x])[k]; +p(a[x])[l]; +p(c); if (p(a)[k]) { .print(k) }; if (p(a)[l]) { .print(l) }; if (p(b)[l]) { .print(never) };
  .findall(X, p(X), M); .print(M);
  -p(b[y]); .findall(X, p(X), N); .print(N);
  .count(p(_), C); .print(C); .stopMAS.
