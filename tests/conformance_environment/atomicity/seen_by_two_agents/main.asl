!go.
+!go <-
  makeArtifact("t","Ledger",[],Id); focus(Id); .wait(200);
  transfer(30); .wait(60);
  !try(slow(200)); .wait(60);
  !try(crash(5)); .wait(60);
  .findall(c(X,Y),from(X) & to(Y),L); .print(L);
  .send(bob,achieve,tell); .wait(60); .stopMAS.
+!try(Op) <- Op; .print("done ",Op).
-!try(Op)[env_failure_reason(R)] <- .print("failed ",R).
+from(X) : to(Y) <- .print("from ",X," while to is ",Y).
+to(Y) : from(X) <- .print("to ",Y," while from is ",X).
