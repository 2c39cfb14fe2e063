// A list of a thousand numbers is built and added up, again and again.
!repeat($times).
+!build(0, L, L).
+!build(I, T, L) : I > 0 <- !build(I - 1, [I | T], L).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     !build($k, [], L);
     !sums($n, L, S);
     .print("end ", S);
     !repeat(R - 1).
+!sums(1, L, S) <- !sum(L, 0, S).
+!sums(I, L, S) : I > 1 <- !sum(L, 0, _); !sums(I - 1, L, S).
+!sum([], S, S).
+!sum([H | T], A, S) <- !sum(T, A + H, S).
