// A belief or rule whose list has an open end matches lists of any length, each time with variables of its own.
p([1,2|_]). q([A|B],A,B). r(X,[X|T],T). r(X,[_|T],U) :- r(X,T,U).
!t.
+!t <- ?p([A,B,C]); .print(A,B); ?p([D,E,F,7]); .print(D,E); if (not p([1])) { .print(no) }; if (p([1,2])) { .print(exact) };
  ?q([5,6,7],H,R); .print(H,R); ?q([8],I,S); .print(I,S); ?q(V,9,[10]); .print(V);
  .findall(t(X,Y), r(X,[1,2,3],Y), L); .print(L);
  .findall(X, r(X,[a,b],_), M); .print(M);
  !g([1,2,3]); .stopMAS.
+!g([]) <- .print(end).
+!g([X|T]) <- .print(X, T); !g(T).
