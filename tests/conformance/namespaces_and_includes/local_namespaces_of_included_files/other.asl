+!go <- .findall(X, mine::x(X), L); .print("before ", L); !after.
{ namespace(mine, local) }
mine::x(3).
+!after <- .findall(X, mine::x(X), L); .print("after ", L); -+mine::x(4); ?mine::x(Y); .print(Y).
