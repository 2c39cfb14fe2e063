// Messages to oneself: a list of beliefs, goals with and without arguments, and what takes them back.
!t.
+!t <- .my_name(Me); .send(Me, tell, [p(1),p(2)[a]]); .send(Me, achieve, g(1)); .send(Me, achieve, h); .wait(50);
   .findall(X, p(X), L); .print(L); .send(Me, untell, p(1)); .wait(20); .findall(X, p(X), M); .print(M);
   .send(Me, unachieve, w); .wait(20); .print(end); .stopMAS.
+!g(X) <- .print(g, X).
+!h <- .print(h); !w.
+!w <- .wait(500); .print(never).
