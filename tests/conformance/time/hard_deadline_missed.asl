// A goal with a hard deadline fails when its time is over.
!start.
+!start <- !slow[hard_deadline(200)]; .print(bad).
+!slow <- .print(begun); .wait(3000); .print(never).
-!start[error(E)] <- .print(E); .stopMAS.
