!start.
+!start <- .wait(200); .send(bob, achieve, learn); .send(bob, askOne, known(_), Answer); .print(Answer); .stopMAS.
