!go.
+!go <-
  makeArtifact("c","Counter",[1],C);
  createWorkspace("lab"); joinWorkspace("lab",W);
  makeArtifact("c","Counter",[100],C2); focus(C2);
  ?count(N); !where(Ps); .print("in lab ",N," ",Ps);
  quitWorkspace(W);
  .findall(X,count(X),L); .findall(X,focusing(_,X,_,_,_,_),F); !where(Ps2); .print("quit ",L," ",F," ",Ps2);
  !act(C2);
  lookupArtifact("c",C3); focus(C3); ?count(M); .print("current is main ",M); stopFocus(C3);
  joinWorkspace("/main/lab"); focus(C2); ?count(K); .print("back ",K);
  .stopMAS.
+!where(S) <- .findall(P,joinedWsp(_,_,P),L); .sort(L,S).
+!act(C) <- inc[artifact_id(C)].
-!act(_)[error(E)] <- .print("cannot act there ",E).
