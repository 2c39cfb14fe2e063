corner(1, 2, 0).
corner(2, 2, 2).
corner(3, 0, 2).
corner(4, 0, 0).

!patrol(1).

+!patrol(N) : corner(N, X, Y)
  <- navigate_to(X, Y, 0);  // an action of Nav2: the plan waits for its result
     .print("corner ", N);
     !patrol(N mod 4 + 1).

// Something is in the way: it may be gone when the robot comes back.
-!patrol(N)
  <- .print("I need help, or time: corner ", N, " is out of reach");
     .wait(2000);
     !patrol(N mod 4 + 1).

@charge[urgency(10), needs(wheels)]  // takes the wheels from the patrol
+battery(Percent, _) : Percent < 60 & not .desire(charge)
  <- .print("battery at ", Percent, " %");
     !charge[achieves(docked(false) & battery(Full, _) & Full > 90, 2000), retry(3, 5000)].  // the patrol continues to the same corner

+!charge
  <- navigate_to(0.4, 1, 0);
     dock;
     .wait(battery(100, _) | battery(_, discharging) | docked(false));
     ?battery(100, _);
     undock.

-!charge[error_msg(Text)]
  <- .print("I need help, I cannot charge: ", Text);
     .stopMAS(0, 1).
