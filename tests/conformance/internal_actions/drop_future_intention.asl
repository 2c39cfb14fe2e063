// An intention whose plan will post a goal is dropped before it does, by name of that goal.
!start.
!work(a).
!work(b).
+!start
  <- .wait(50);
     .drop_future_intention(paint(a));
     .wait(150);
     .stopMAS.
+!work(X) <- .wait(100); !paint(X).
+!paint(X) <- .print(X).
