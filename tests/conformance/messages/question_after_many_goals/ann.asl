!start.
+!start <- .wait(100); .send(bob, achieve, burst); .wait(50);  .send(bob, askOne, count(_), A); .print(A); .send(bob,askAll,last(_),L); .print(L); .stopMAS.
