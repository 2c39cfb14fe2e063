// `N::~p(X)` with a variable for the namespace finds negated literals only, and `N::p(X)` the others.
a::p(1). a::~p(3). p(4). ~p(5). b::p(6). b::~p(7). b::q(8).
!t.
+!t <-
   .setof(t(N,X), N::~p(X), A); .print(A);
   .setof(t(N,X), N::p(X), B); .print(B);
   M = b; .findall(X, M::~p(X), C); .findall(X, M::p(X), D); .print(C, " ", D);
   if (not M::~q(_)) { .print("no negation of q") };
   -M::~p(7); .findall(X, M::~p(X), E); .findall(X, M::p(X), F); .print(E, " ", F);
   +M::~q(9); .findall(X, M::~q(X), G); .findall(X, M::q(X), H); .print(G, " ", H);
   .stopMAS.
