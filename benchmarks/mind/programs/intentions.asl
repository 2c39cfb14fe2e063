// A thousand intentions take turns.
!start.
+!start <- !spawn($k).
+!spawn(0).
+!spawn(I) : I > 0 <- !!work(I, $n); !spawn(I - 1).
+!work(I, 0) <- +fin(I).
+!work(I, M) : M > 0 <- !work(I, M - 1).
+fin(I) : .count(fin(_), $k) <- .stopMAS.
