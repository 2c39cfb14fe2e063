+!want(N) : .my_name(Me) <- take(Me,N); .print("took ",N).
