// Fibonacci numbers by goals that give results back.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !fib($n, F); .print("end ", F); !repeat(R - 1).
+!fib(0, 0).
+!fib(1, 1).
+!fib(I, F) : I > 1 <- !fib(I - 1, A); !fib(I - 2, B); F = A + B.
