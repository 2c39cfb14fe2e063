// Fibonacci numbers by rules.
fib(0, 0).
fib(1, 1).
fib(I, F) :- I > 1 & fib(I - 1, A) & fib(I - 2, B) & F = A + B.
!start.
+!start : fib($n, F) <- .stopMAS.
