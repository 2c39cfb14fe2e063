// With all_unifs in its label, each answer of the context is an option; the first one is selected.
p(1). p(2). p(3).
!start.
+!start <- !g; !h; .stopMAS.
@g[all_unifs] +!g : p(X) & X > 1 <- .print(g(X)).
+!h : p(X) & X > 1 <- .print(h(X)).
