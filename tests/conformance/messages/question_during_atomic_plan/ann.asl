!start.
+!start <- .wait(100); .send(bob, achieve, work); .wait(50); .send(bob, askOne, state(_), A); .print(A); .stopMAS.
