// A literal made of parts that variables hold.
!t.
+!t <- Y = 1; Z = f(Y,V); N = p; T =.. [N,[Y,Z,[Y|W]],[a(Y),b]]; V = 2; W = [3]; .print(T);
   T =.. [M,A,_]; .print(M, A); p(Q,_,_) = T; .print(Q);
   U =.. [q,[],[]]; .print(U); if (p(1,f(1,2),[1,3])[b] = T) { .print(same) };
   q(8,9)[c,d] =.. L; .print(L); ~q(8) =.. K; .print(K); .stopMAS.
