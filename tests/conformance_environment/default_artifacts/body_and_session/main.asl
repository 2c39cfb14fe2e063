!go.
+!go <-
  makeArtifact("c","Counter",[],C); focus(C);
  ?focusing(C,N,T,W,WN,WP)[artifact_name(B)]; .print(N," ",T," ",WN," \"",WP,"\" ",B);
  ?focusing(C,_,_,_,_,_)[percept_type(K)]; .print(K);
  ?joinedWsp(W,WN1,WP1)[artifact_name(S)]; .print(WN1," \"",WP1,"\" ",S);
  createWorkspace("lab"); joinWorkspace("lab",L);
  ?joinedWsp(L,LN,LP)[artifact_name(S2)]; .print(LN," \"",LP,"\" ",S2);
  makeArtifact("c2","Counter",[],C2); focus(C2);
  ?focusing(C2,N2,_,L,WN2,WP2)[artifact_name(B2)]; .print(N2," ",WN2," \"",WP2,"\" ",B2);
  .stopMAS.
