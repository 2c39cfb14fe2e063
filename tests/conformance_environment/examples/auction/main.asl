!sell.
+!sell : item(I) & best(N,_) <- .print("sells ",I,", best is ",N); .wait(50); open; .wait(400); close;
  ?best(Price,Who); .print(I," to ",Who," for ",Price); .wait(50); .stopMAS.
+state(S) <- .print("state ",S).
