!go.
+!go <-
  makeArtifact("s","Store",[],Id);
  !!fetch(apples); !!fetch(pears); .wait(20);
  put(pears,2); .wait(20); put(apples,1); .wait(20);
  !!meet(3); .wait(20); put(pears,1); put(pears,1); put(pears,1); .wait(20);
  !broken;
  .stopMAS.
+!fetch(What) <- take(What); .print("got ",What).
+!meet(N) <- wait_for(pears,N,S); .print("there are ",S).
+!broken <- take("bombs"); .print("never").
-!broken[env_failure_reason(R)] <- .print(R).
