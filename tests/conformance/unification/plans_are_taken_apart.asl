// The operator =.. takes a plan apart into label, trigger, context and body, and puts it together.
!start.
+!start <- P = { @l +!g(1) : b(2) <- .print(3); .print(4) }; P =.. L; .print(L); L = [_|R]; Q =.. [k|R]; .print(Q); .stopMAS.
