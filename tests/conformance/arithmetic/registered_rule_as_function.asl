// A rule that is registered as a function is called in expressions: its first answer counts.
{ register_function("my.sum", 2, "sum") }
sum(X, Y, Z) :- Z = X + Y.
sum(_, _, 100).
big(X) :- my.sum(X, 1) > 10.
!start.
+!start
  <- X = my.sum(2, 3); .print(X);
     .print(my.sum(my.sum(1, 1), 2) * 10);
     !show(my.sum(4, 5));
     !check(9); !check(10);
     .stopMAS.
+!show(V) <- .print(V).
+!check(N) : big(N) <- .print(big(N)).
+!check(N) <- .print(small(N)).
