!go.
+!go <-
  makeArtifact("g","Giver",[],Id);
  give(A,B,C); .print(A);
  if (.ground(B)) { .print("bound") } else { .print("unset stays unbound") };
  .print(C);
  same(X,X); .print(X);
  !try;
  .stopMAS.
+!try <- give_and_fail(V); .print("never").
-!try[env_failure_reason(R)] <- .print(R).
