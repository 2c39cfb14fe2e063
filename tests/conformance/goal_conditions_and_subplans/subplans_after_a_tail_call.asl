// A plan with sub-plans whose last formula calls a goal stays: its sub-plans serve what that goal calls.
!t.
+!t <- !go(3); !next; .stopMAS.
+!go(N) <- .print(go, N); !walk(N). {
  +!inner(X) <- .print(inner, X, of, N).
  +seen(X) <- .print(noticed, X, of, N).
}
+!walk(0) <- .print(arrived).
+!walk(N) : N > 0 <- !inner(N); ++seen(N); .wait(30); !walk(N-1).
+!inner(X) <- .print(outer, X).
+!next <- !inner(9); +seen(9).
+seen(9) <- .print("root 9").
