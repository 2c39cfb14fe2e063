// Control statements and forks print as the internal actions that they are made of.
!start.
+!start <- .print({ if (a) { b } else { c; d } }); .print({ for (a(1)) { b }; c }); .print({ while (not a) { b } }); .print({ a |&| b |&| c }); .print({ a ||| (b; c) }); .stopMAS.
