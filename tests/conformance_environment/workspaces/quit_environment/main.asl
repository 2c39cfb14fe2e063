!go.
+!go <-
  makeArtifact("c","Counter",[],C); focus(C);
  createWorkspace("lab"); joinWorkspace("lab");
  quitFromEnvironment;
  .findall(P,joinedWsp(_,_,P),L); .findall(X,count(X),L2); .print("out ",L," ",L2);
  !act;
  joinWorkspace("/main"); focus(C); ?count(N); .print("back ",N);
  .stopMAS.
+!act <- inc.
-!act[error(E),env_failure_reason(R)] <- .print(E," ",R).
