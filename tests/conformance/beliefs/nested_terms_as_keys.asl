// Beliefs with nested structures and lists as arguments are found, replaced and deleted by them.
b(f(g(1),[a,[b]]),1). b(f(g(2),[a,[b]]),2). b(f(g(X),[a]),3) :- X = 9.
!t.
+!t <- ?b(f(g(1),[a,[b]]),A); .print(A); ?b(f(g(2),L),B); .print(L,B); ?b(f(g(9),[a]),C); .print(C);
   +b(f(g(1),[a,[b]]),1); .count(b(_,1),N); .print(N); -b(f(g(1),[a|_]),_); .count(b(_,_),M); .print(M);
   +c([f(1),[2]]); if (c([f(1)|T])) { .print(T) }; if (not c([f(2)|_])) { .print(none) };
   -+c([3]); .findall(K, c(K), Ks); .print(Ks); .stopMAS.
