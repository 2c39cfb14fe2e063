// A plan body prints in braces, and without them when it is taken out of a plan.
!start.
+!start <- .print({ a; !b; +c }); X = { !!g(1); ?t(2); -+d }; .print(X); .print([{ a }, { }]); P = { @l +!g : c <- a; b }; P = { @_ +!_ : _ <- B }; .print(B); .print(P); .stopMAS.
