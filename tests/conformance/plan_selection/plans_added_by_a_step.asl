// A plan that a step adds comes before the others for the same event.
!t.
+!t <- !g(1); +{ +!g(X) <- .print(added, X) }; !g(2); .stopMAS.
+!g(X) <- .print(old, X).
