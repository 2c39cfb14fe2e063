// `--b(X)` deletes one belief in an intention of its own, and leaves its variables free.
b(1). b(2)[x]. b(3). c(4). d(1,2). d(1,3). d(2,3).
!t.
+!t <- --b(X); .findall(B, b(B), L); .print(L, " ", X); X = 7; .print(X);
   --d(1,Y); .findall(A-B, d(A,B), M); .print(M); Y = 5; .print(Y);
   --d(Z,Z); .print(same); --c(9); ?c(C); .print(C); !u(4).
+!u(N) <- --c(N); .count(c(_), K); .print(K); .stopMAS.
-b(X) <- .print(gone, X).
-d(X,Y) <- .print(gone, X, Y).
