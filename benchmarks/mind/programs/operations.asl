// An operation of an artifact is called, again and again: there and back with a result.
!start.
+!start <- makeArtifact("board", "board.Board", [1], Id); focus(Id); !repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !calls($n); .print("end"); !repeat(R - 1).
+!calls(0).
+!calls(I) : I > 0 <- next(I, V); !calls(V).
