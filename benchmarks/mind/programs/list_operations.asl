// The internal actions for lists, on a list of $k numbers.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     .findall(I, .range(I, 1, $k), L);
     !loop($n, L);
     .print("end");
     !repeat(R - 1).
+!loop(0, _).
+!loop(I, L) : I > 0
  <- .length(L, N);
     .nth(N div 2, L, X);
     .member(X, L);
     .concat(L, [I], C);
     .reverse(C, B);
     .sort(B, S);
     .max(S, Most);
     .delete(X, S, D);
     .difference(D, [X], F);
     !loop(I - 1, L).
