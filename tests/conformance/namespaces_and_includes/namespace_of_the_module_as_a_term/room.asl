seats(4).
doors([this_ns, f(this_ns)]).
+!show <- !count(this_ns); ?doors(D); .print(D); V = this_ns; .print(V); L = [this_ns|[b]]; .print(L); .print({+!g(this_ns)}).
+!count(NS) : NS::seats(N) <- .print(NS, " has ", N, " seats").
-!count(NS) <- .print("no seats in ", NS).
