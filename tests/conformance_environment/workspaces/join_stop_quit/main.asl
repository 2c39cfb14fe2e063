!go.
+!go <-
  .findall(N,joinedWsp(_,N,_),J0); .print(J0);
  createWorkspace("office"); joinWorkspace("office",W); .findall(N,joinedWsp(_,N,_),J1); .sort(J1,S1); .print(S1);
  makeArtifact("c","Counter",[5],C); makeArtifact("d","Counter",[8],D);
  focus(C); focus(D); .findall(N,count(N),L); .sort(L,SL); .print(SL);
  .findall(N,focusing(_,N,_,_,_,_),F); .sort(F,SF); .print(SF);
  stopFocus(C); .findall(N,count(N),L2); .print(L2); .findall(N,focusing(_,N,_,_,_,_),F2); .print(F2);
  inc[artifact_id(C)]; .print("used without focus");
  quitWorkspace(W); .findall(N,count(N),L3); .print(L3); .findall(N,focusing(_,N,_,_,_,_),F3); .print(F3);
  .findall(N,joinedWsp(_,N,_),J2); .print(J2);
  !try(inc[artifact_id(C)]);
  joinWorkspace("/main/office",W2); focus(C); ?count(N4); .print("back: ",N4);
  .wait(60); .stopMAS.
+!try(A) <- A; .print("not reached").
-!try(A)[error(E)] <- .print("not any more: ",E).
+count(N) <- .print("+",N).
-count(N) <- .print("-",N).
