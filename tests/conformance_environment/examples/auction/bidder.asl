limit(ann,8). limit(bob,20). limit(eve,14).
+state(open) : best(N,Who) <- !consider(N,Who).
+best(N,Who) : state(open) <- !consider(N,Who).
+state(closed) : best(N,Who) <- if (.my_name(Who)) { .print("won") } else { .print("lost") }.
+!consider(N,Who) : .my_name(Me) & Me \== Who & limit(Me,Most) & step(S) & N + S <= Most <- bid(Me,N+S).
+!consider(_,_).
-!consider(_,_)[env_failure_reason(too_low(_,_))].
