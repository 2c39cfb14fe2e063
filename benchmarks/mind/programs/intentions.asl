// A thousand intentions take turns.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- -+left($k); -+round(R); .print("begin"); !spawn($k).
+!spawn(0).
+!spawn(I) : I > 0 <- !!work($n); !spawn(I - 1).
+!work(0) <- !finished.
+!work(M) : M > 0 <- !work(M - 1).
@finished[atomic]
+!finished <- ?left(N); -+left(N - 1); ?left(L); if (L == 0) { .print("end"); ?round(R); !!repeat(R - 1) }.
