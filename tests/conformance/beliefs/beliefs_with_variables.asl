// Beliefs with variables are beliefs for every value of these.
!t.
+!t <- +p(1,_)[k]; +p(2,_); ?p(1,A); .print(first); ?p(2,b); .print(second); if (not p(3,_)) { .print(third) };
  .count(p(_,_), B); .print(B); .abolish(p(1,_)); .count(p(_,_), C); .print(C);
  +p(X,X); if (p(4,4)) { .print(same) }; if (not p(4,5)) { .print(other) };
  .count(p(_,_), D); .print(D);
  +q(f(_)); if (q(f(1))) { .print(deep) }; -q(f(_)); if (not q(_)) { .print(gone) };
  .stopMAS.
