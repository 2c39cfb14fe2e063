// Sub-plans that call each other as their last formula, and a plan with a goal condition that calls itself so.
!t.
+!t <- !count(3); .print(counted); !until(0); .print(reached); .stopMAS.
+!count(N) <- !down(N). {
  +!down(0) <- !last.
  +!down(M) : M > 0 <- .print(M, of, N); !down(M-1).
  +!last <- .print(last, of, N).
}
+!until(N) <: at(2) <- .print(until, N); +at(N); .wait(20); !until(N+1).
