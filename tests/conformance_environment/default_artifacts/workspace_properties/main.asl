!go.
+!go <-
  makeArtifact("c","Counter",[],C);
  lookupArtifact("workspace",W); focus(W); .wait(60);
  +watching;
  makeArtifact("d","Counter",[]); .wait(60); !show;
  disposeArtifact(C); .wait(60); !show;
  createWorkspace("lab"); .wait(60);
  linkWorkspace("/main/lab","near"); .wait(60);
  ?linkedWsp(N,P); .print("link \"",N,"\" \"",P,"\"");
  .stopMAS.
+!show <- .findall(N,artifact(_,N,"Counter"),L); .sort(L,S); .print("now ",S).
+artifact(_,N,T)[artifact_name(workspace)] : watching <- .print("+ ",N," ",T).
-artifact(_,N,_) : watching <- .print("- ",N).
+childWsp(N) <- .print("+ child ",N).
