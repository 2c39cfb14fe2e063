mine::x(2).
+!part <- .findall(X, mine::x(X), L); .print("part ", L).
