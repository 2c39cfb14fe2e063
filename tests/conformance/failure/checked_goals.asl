// What a goal or a plan was to achieve is tested when the plan ends; the condition shares its variables with them.
docked(false). battery(12, discharging). at(hall).
!t.
+!t
  <- !go(Room)[achieves(at(Room) & not Room == hall, 500)];
     .print("in the ", Room);
     !dock[achieves(docked(true) & battery(B, charging), 100), retry(1, 50)];
     .print("charging at ", B);
     !dock[achieves(battery(99, _), 100), retry(1), within(10000)];
     .print("goes on");
     !stop[achieves(moving(no))];
     .stopMAS.

+!go(kitchen) <- !!drive.
+!drive <- .wait(50); .print("driving"); -+at(bath); .wait(50); -+at(kitchen).

+!dock : docked(false) <- .print("docking"); -+docked(true).
@again[achieves(battery(_, charging)), cleanup(leave)]
+!dock <- .print("docking again"); ?battery(B, State); .print(State); -battery(B, State); +battery(13, charging).
-!dock[error(E), found(F), attempts(N)] <- .print(E, ": ", F, " after ", N).
+!leave <- .print(never).

+!stop <- .fail(error(no_brakes)).
-!stop[error(E)] <- .print(E).
