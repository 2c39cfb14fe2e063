+!look <-
  .send(maker,achieve,make); .wait(20);
  whoami(A); .print("nothing focused: ",A);
  lookupArtifact("third",T); focus(T); whoami(B); .print("focused: ",B);
  lookupArtifact("second",S); focus(S); whoami(C); .print("focused first: ",C);
  makeArtifact("own1","Named",["own 1"]); makeArtifact("own2","Named",["own 2"],O); focus(O); whoami(D); .print("own: ",D);
  lookupArtifact("shared",H); whoami(E)[artifact_id(H)]; .print("exact id: ",E).
