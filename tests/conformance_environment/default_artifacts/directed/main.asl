!go.
+!go <-
  createWorkspace("lab"); joinWorkspace("lab",L); joinWorkspace("/main",_);
  makeArtifact("c","Counter",[7],C)[artifact_name(workspace),wsp(lab)];
  lookupArtifact("lab/c",C2); focus(C2); ?count(N); .print("made in lab ",N); stopFocus(C2);
  lookupArtifact("lab/body_main",B); lookupArtifact("workspace",W);
  !fly(W);
  focus(C)[artifact_id(B)]; ?count(M); .print("focused by body ",M);
  stopFocus(C)[artifact_id(B)]; .findall(X,count(X),Xs); .print("unfocused ",Xs);
  .stopMAS.
+!fly(W) <- fly[artifact_id(W)].
-!fly(W)[env_failure_reason(unknown_operation(W,Op))] <- .print("unknown_operation \"",Op,"\"").
