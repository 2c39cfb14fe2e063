+!meet(Round) : .my_name(Me) <- .wait(50); .print("comes ",Round); meet(Me,Others); .length(Others,N); .sort(Others,S); .print("met ",N,": ",S); meet(bob,_); .print("again").
