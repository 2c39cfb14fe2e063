// The failure of a goal without a plan inside a plan with sub-plans: only its sub-plans are asked for a handler.
!t.
+!t <- !a; .print(after_a); !b; .print(after_b); .stopMAS.
-!t <- .print(t_failed); .stopMAS.
+!a <- !nothing(1). {
  -!nothing(X)[error(E)] <- .print(inner, " ", X, " ", E).
}
+!b <- !nothing(2). {
  +!other <- true.
}
-!nothing(X)[error(E)] <- .print(outer, " ", X, " ", E).
