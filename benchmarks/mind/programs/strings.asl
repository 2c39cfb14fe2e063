// A text is put together from values, and taken apart.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !loop($n); .print("end"); !repeat(R - 1).
+!loop(0).
+!loop(I) : I > 0
  <- .concat("robot ", I, " is at ", p(I, dock), S);
     .length(S, L);
     .substring(S, P, 2, 5);
     .upper_case(P, U);
     .replace(S, "o", "0", Z);
     .term2string(T, "f(1, b)");
     .term2string(T, V);
     !loop(I - 1).
