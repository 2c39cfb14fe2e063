// A hundred plans for one trigger, told apart by their first argument; the last is the one that is wanted.
!start.
+!start <- !run($n); .stopMAS.
+!run(0).
+!run(I) : I > 0 <- !do(kind100, I); !run(I - 1).
$plans
