// Negated literals in variables and structures: `~` is part of what unifies.
q(~p(1)). q(p(2)). ~r(3). r(4).
!t.
+!t <- ?q(~p(X)); .print(X); ?q(p(Y)); .print(Y); 
   if (not q(~p(2))) { .print(no) }; if (~p(1) = ~p(1)) { .print(same) }; if (not (~p(1) = p(1))) { .print(other) };
   .findall(Z, q(Z), L); .print(L); ~p(A) = ~p(7); .print(A); if (not (~p(7) = ~p(8))) { .print(eight) };
   B = ~r(3); if (B) { .print(believed) }; if (f(~p(C),C) = f(~p(9),D)) { .print(C, D) };
   .stopMAS.
