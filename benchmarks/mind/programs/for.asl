// A loop over numbers, and a little arithmetic.
!start.
+!start <- for (.range(I, 1, $n)) { Y = I * 2 + 1 - I }; .stopMAS.
