// A string inside another term prints between quotes, its own quotes as they are.
!start.
+!start <- X = "say \"no\""; .print(X); .print([X]); .print(f("\"")); .stopMAS.
