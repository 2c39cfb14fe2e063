// Sends all others to work, and waits for them.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- -+left($k); -+round(R); .print("begin"); .broadcast(achieve, work).
@finished[atomic]
+!finished <- ?left(N); -+left(N - 1); ?left(L); if (L == 0) { .print("end"); ?round(R); !!repeat(R - 1) }.
