// What a plan binds in a list of its goal is free again for the failure plan, and what that binds stays.
!t.
+!t <- !g([A,B]); .print(A, " ", B); !h(f(C),[1|T]); .print(C, " ", T); .stopMAS.
+!g([X,Y]) <- X = 1; Y = 7; .print(X, Y); .fail.
-!g([X,Y]) <- Y = 2; X = 3; .print(X, Y).
+!h(f(X),[1|T]) <- X = 5; T = [9]; .fail.
-!h(f(X),L) <- X = 6; L = [_,8]; .print(X, L).
