// Sends no goal.
!start.

+!start <- .wait(pose(_, _, _)); .print("here"); .wait(60000).
