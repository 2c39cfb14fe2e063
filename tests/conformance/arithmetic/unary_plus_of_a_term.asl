// Unary plus of what is no number is not a number.
!start.
+!start <- X = foo; .print(+X); Y = 3; .print(+Y); .print(- -Y); .stopMAS.
