// A thousand percepts, ten of which change in each round, each with a plan for it.
!start.
+!start <- makeArtifact("board", "board.Board", [1000], Id); focus(Id); !repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !rounds($n); .print("end"); !repeat(R - 1).
+!rounds(0).
+!rounds(I) : I > 0 <- change(10); !rounds(I - 1).
$plans
