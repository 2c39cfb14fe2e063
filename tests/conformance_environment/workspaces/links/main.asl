!go.
+!go <-
  createWorkspace("lab"); createWorkspace("hall");
  linkWorkspace("/main/lab","near");
  joinWorkspace("near",W); ?joinedWsp(W,N,P); .print(N," \"",P,"\"");
  joinWorkspace("/main",_);
  makeArtifact("near/c","Counter",[5],C); focus(C); ?count(X); .print(X);
  linkWorkspaces("hall","lab","next"); joinWorkspace("hall/next",W2); ?joinedWsp(W2,N2,P2); .print(N2," \"",P2,"\"");
  joinWorkspace("/main",_);
  !t(taken); !t(nowhere);
  .stopMAS.
+!t(taken) <- linkWorkspace("/main/hall","near").
+!t(nowhere) <- linkWorkspace("/main/attic","x").
-!t(N)[env_failure_reason(R)] <- .print(N," ",R).
