// The answers of one rule share variables: what a round binds is free again in the next.
rr(f(Z),W) :- .member(W,[1,2,3]).
ss([W|T]) :- .member(W,[1,2]).
!t.
+!t <- for (rr(T,W)) { T = f(W); .print(T) };
   for (ss(L)) { L = [A|B]; B = [A]; .print(L) };
   for (rr(T,W) & rr(U,V) & W < V) { T = f(V); U = f(W); .print(T, U) };
   .stopMAS.
