// A goal ends as soon as its own plan, or one below it, makes its goal condition true.
!start.
+!start <- !g; .print(one); !h(5); .print(two); .stopMAS.
+!g <: n <- .print(g1); +n; .print(bad).
+!h(X) <: m(V) & V > 2 <- !work; .print(bad). {
  +!work <- .print(w(X)); +m(1); .print(small); +m(X); .print(bad).
}
