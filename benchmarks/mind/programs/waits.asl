// Conditions are awaited and come true, while $k other intentions wait for conditions of their own.
!start.
+!start <- !spawn($k); !repeat($times).
+!spawn(0).
+!spawn(I) : I > 0 <- !!sleep(I); !spawn(I - 1).
+!sleep(I) <- .wait(wake_up(I)).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !gen($n); .print("end"); !repeat(R - 1).
+!gen(0).
+!gen(I) : I > 0 <- !!come(I); .wait(b(I)); -b(I); !gen(I - 1).
+!come(I) <- +b(I).
