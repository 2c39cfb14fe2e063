// Two agents: a ball goes to and fro, an even number of times.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- -+round(R); .print("begin"); .send(pong, achieve, ball($n - 1)).
+!ball(0) <- .print("end"); ?round(R); !!repeat(R - 1).
+!ball(I) : I > 0 <- .send(pong, achieve, ball(I - 1)).
