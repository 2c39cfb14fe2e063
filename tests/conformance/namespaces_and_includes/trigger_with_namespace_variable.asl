// A plan whose namespace is a variable is for the events of every namespace, in the order of the plans.
!start.
+!start <- !a::g(1); !b::g(2); !g(3); M = c; +M::v(4); -c::v(4); .stopMAS.
+!N::g(X) : N \== b <- .print(N," ",X).
+!b::g(X) <- .print(own(X)).
+N::v(X)[source(self)] <- .print(plus(N,X)).
-N::v(X) <- .print(minus(N,X)).
