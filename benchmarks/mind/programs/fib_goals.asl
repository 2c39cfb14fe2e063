// Fibonacci numbers by goals that give results back.
!start.
+!start <- !fib($n, F); .stopMAS.
+!fib(0, 0).
+!fib(1, 1).
+!fib(I, F) : I > 1 <- !fib(I - 1, A); !fib(I - 2, B); F = A + B.
