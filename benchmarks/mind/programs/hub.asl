// Plays a ball to $k others by turns; each plays it back at once.
joined(0).
@join[atomic]
+!join(Agent) <- ?joined(N); +member(N, Agent); -+joined(N + 1); if (N + 1 == $k) { !!repeat($times) }.
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- -+round(R); .print("begin"); !ball($n).
+!ball(0) <- .print("end"); ?round(R); !!repeat(R - 1).
+!ball(I) : I > 0 & K = I mod $k & member(K, Agent) <- .send(Agent, achieve, ball(I - 1)).
