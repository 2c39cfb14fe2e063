// A variable in several places of a structure, of a list and of annotations.
!t.
+!t <- f(X,g(X),[X|T]) = f(1,g(1),[1,2,3]); .print(X, T);
   if (not (f(Y,g(Y)) = f(1,g(2)))) { .print(no) }; if (f(Z,Z) = f(W,5)) { .print(Z, W) };
   h(A,B,a)[x(A)] = h(B,2,a)[x(2)]; .print(A, B);
   if (p(C)[x(C)] = p(3)[x(3),y]) { .print(C) }; if (not (p(D)[x(D)] = p(3)[x(4)])) { .print(annotation) };
   [E,E|F] = [k(_),k(6),8]; .print(E, F);
   .stopMAS.
