+!meet(Round) : .my_name(Me) <- .print("comes ",Round); meet(Me,Others); .length(Others,N); .sort(Others,S); .print("met ",N,": ",S); !!again.
+!again <- .wait(30); meet(ann,_); .print("again").
