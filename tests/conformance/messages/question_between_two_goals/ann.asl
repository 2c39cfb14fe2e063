!start.
+!start <- .wait(100); .send(bob, achieve, set(1)); .send(bob, askOne, v(_), A); .send(bob, achieve, set(2)); .send(bob, askOne, v(_), B); .print(A, B); .stopMAS.
