// Two agents: a ball goes to and fro.
!start.
+!start <- .send(pong, achieve, ball($n)).
+!ball(0) <- .stopMAS.
+!ball(I) : I > 0 <- .send(pong, achieve, ball(I - 1)).
