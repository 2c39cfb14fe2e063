// A step that deletes a plan given as a term.
!t.
+!t <- !g(1); -{ +!g(X) : X > 0 <- .print(first, X) }; !g(2); -{ +!g(9) <- .print(none) }; !g(3); .stopMAS.
+!g(X) : X > 0 <- .print(first, X).
+!g(X) <- .print(second, X).
