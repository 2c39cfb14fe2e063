!go.
+!go <-
  makeArtifact("d","Dial",[],Id); focus(Id); .wait(50); .print("focused");
  ?level(L)[artifact_id(Id),artifact_name(N),percept_type(T),source(S),workspace(W,_)]; .print(L," ",N," ",T," ",S," ",W);
  turn(5); ?level(L5); +seen(L5); .wait(50); ?seen(L6); .print("after turn ",L6);
  turn(5); .wait(50);
  mark(a); mark(b); .wait(50); ?mark(M); .print("newest ",M); .findall(X,mark(X),Ms); .print(Ms);
  first(z); .wait(50); ?mark(M2); .print("changed last ",M2);
  gone(b); .wait(50); stopFocus(Id); .wait(50);
  .findall(X,mark(X),End); .count(level(_),C); .print(End," ",C); .stopMAS.
+level(X)[source(percept)] <- ?level(Y); .print("+level ",X," believed ",Y).
-level(X) <- .findall(Y,level(Y),L); .print("-level ",X," believed ",L).
+turned(X)[percept_type(T)] : not turned(_) <- ?level(Y); .print("turned ",X," ",T," believed ",Y).
+mark(X) <- .print("+mark ",X).
-mark(X) <- .print("-mark ",X).
