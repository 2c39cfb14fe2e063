// Belief events, while $k other intentions wait.
!start.
+!start <- !spawn($k); !repeat($times).
+!spawn(0).
+!spawn(I) : I > 0 <- !!sleep(I); !spawn(I - 1).
+!sleep(I) <- .wait("+wake_up").
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     !gen($n);
     .print("end");
     .abolish(b(_));
     !repeat(R - 1).
+!gen(0).
+!gen(I) : I > 0 <- +b(I); !gen(I - 1).
+b(X) : X > 0 <- Y = X + 1.
