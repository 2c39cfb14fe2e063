// Variables without value are marked at the top, also negated or annotated ones, and expressions wait for them.
!start.
+!start <- .print(X); .print(~X); .print(X[a]); .print(f(X)); .print(-X, +X, X*2); .stopMAS.
