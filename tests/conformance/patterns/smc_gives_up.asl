// A goal with a single-minded commitment fails when its failure condition is believed.
{ begin smc(home, lost) }
+!home <- .print(walking); .wait(2000); .print(never).
{ end }
!start.
+!start <- !!get_home; .wait(200); +lost.
+!get_home <- !home; .print(bad).
-!get_home <- .print(gave_up); .stopMAS.
