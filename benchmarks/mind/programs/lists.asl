// A list of a thousand numbers is built and added up, again and again.
!start.
+!start <- !build($k, [], L); !repeat($n, L); .stopMAS.
+!build(0, L, L).
+!build(I, T, L) : I > 0 <- !build(I - 1, [I | T], L).
+!repeat(0, L).
+!repeat(I, L) : I > 0 <- !sum(L, 0, S); !repeat(I - 1, L).
+!sum([], S, S).
+!sum([H | T], A, S) <- !sum(T, A + H, S).
