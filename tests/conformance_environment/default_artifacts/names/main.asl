!go.
+!go <-
  makeArtifact("c","Counter",[]);
  getCurrentArtifacts(L); .sort(L,S); .print(S);
  for (.member(N,L)) { lookupArtifact(N,_) };
  .print("all are found");
  createWorkspace("lab"); joinWorkspace("lab");
  getCurrentArtifacts(L2); .sort(L2,S2); .print("in lab ",S2);
  .stopMAS.
