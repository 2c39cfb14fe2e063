!go.
+!go <-
  createWorkspace("w"); createWorkspace("w/deep"); createWorkspace("v");
  makeArtifact("/main/w/c","Counter",[1],A);
  joinWorkspace("w"); joinWorkspace("deep"); joinWorkspace("/main/v");
  makeArtifact("../w/deep/c","Counter",[2],B);
  joinWorkspace("/main/w");
  makeArtifact("deep/d","Counter",[3],C);
  focus(A); focus(B); focus(C);
  ?count(X)[artifact_id(A)]; ?count(Y)[artifact_id(B)]; ?count(Z)[artifact_id(C)]; .print(X," ",Y," ",Z);
  lookupArtifact("c",A2); lookupArtifact("/main/w/deep/c",B2); lookupArtifact("../w/deep/d",C2);
  if (A == A2 & B == B2 & C == C2) { .print("same") };
  !nowhere; !taken;
  .stopMAS.
+!nowhere <- makeArtifact("/main/nowhere/c","Counter",[]).
-!nowhere[error(action_failed)] <- .print("no workspace").
+!taken <- makeArtifact("/main/w/c","Counter",[]).
-!taken[env_failure_reason(makeArtifactFailure("artifact_already_present",N))] <- .print("taken \"",N,"\"").
