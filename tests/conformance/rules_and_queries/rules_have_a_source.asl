// A rule belongs to the agent itself, so queries may ask for its source.
s(1). s(2).
r(X) :- s(X).
t(X)[k] :- s(X) & X > 1.
!start.
+!start <- .findall(X,r(X)[source(self)],L); .print(L); .findall(S,r(1)[source(S)],M); .print(M); ?t(2)[|R]; .print(R); if (r(1)[source(bob)]) { .print(bad) } else { .print(no) }; .stopMAS.
