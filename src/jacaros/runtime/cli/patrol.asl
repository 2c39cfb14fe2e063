corner(1, 2, 0).
corner(2, 2, 2).
corner(3, 0, 2).
corner(4, 0, 0).

!patrol(1).

+!patrol(N) : corner(N, X, Y)
  <- navigate_to(X, Y, 0);  // an action of Nav2: the plan waits for its result
     .print("corner ", N);
     !patrol(N mod 4 + 1).

@charge[urgency(10), needs(wheels)]  // takes the wheels from the patrol
+battery(Percent, _) : Percent < 60 & not .desire(charge)
  <- .print("battery at ", Percent, " %");
     !charge[retry(3, 5000)].  // the patrol continues to the same corner

+!charge
  <- navigate_to(0.4, 1, 0);
     dock;  // fails if no current flows
     .wait(battery(100, _) | battery(_, discharging));
     ?battery(100, _);
     undock.
