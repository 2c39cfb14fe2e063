+begin : .my_name(Me) <- !produce(Me,1).
+!produce(Me,N) : N <= 10 <- put(Me,N); !produce(Me,N+1).
+!produce(_,_).
