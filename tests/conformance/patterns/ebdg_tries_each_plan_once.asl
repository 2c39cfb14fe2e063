// With ebdg, each plan is tried once, until the goal is believed.
{ begin ebdg(fixed) }
+!fixed <- .print(glue).
+!fixed <- .print(nails); +fixed.
{ end }
!start.
+!start <- !fixed; .print(done); .stopMAS.
-!start <- .print(failed); .stopMAS.
