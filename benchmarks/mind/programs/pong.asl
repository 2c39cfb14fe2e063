+!ball(I) : I > 0 <- .send(ping, achieve, ball(I - 1)).
