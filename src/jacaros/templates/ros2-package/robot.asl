// The robot drives ahead and back, with the speed of the parameter `speed`.

trips(2).

!start.

+!start : trips(N)
  <- for (.range(_, 1, N)) { !trip };
     .print("done");
     .stopMAS.

+!trip : speed(Speed)
  <- drive(Speed, 0, 3);
     ?pose(X, _, _);
     .print("ahead, at ", math.round(X * 10) / 10, " m");
     drive(-Speed, 0, 3).

// The robot cannot drive: say so, and end with an error.
-!start[error_msg(Why)]
  <- .print("I need help: ", Why);
     .stopMAS(0, 1).
