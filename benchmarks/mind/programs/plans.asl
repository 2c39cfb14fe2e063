// A hundred plans for one trigger, told apart by their first argument; the last is the one that is wanted.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !run($n); .print("end"); !repeat(R - 1).
+!run(0).
+!run(I) : I > 0 <- !do(kind100, I); !run(I - 1).
$plans
