!go.
+!go <-
  createWorkspace("far"); joinWorkspace("/main/far",_); makeArtifact("l2","Lamp",[],L2); focus(L2);
  joinWorkspace("/main",_); makeArtifact("l1","Lamp",[],L1); focus(L1); makeArtifact("s","Switch",[],S);
  !try(all(1));
  linkArtifacts(S,"out",L1); linkArtifacts(S,"out",L2);
  all(5); !show;
  !try(all(-1)); !try(no_port(1)); !try(no_operation);
  caught(R); .print(R); !show;
  .stopMAS.
+!try(Op) <- Op; .print("never").
-!try(Op)[error(E),env_failure_reason(unknown_operation(_,O))] <- .print(E," ",O).
-!try(Op)[error(E),env_failure_reason(R)] <- .print(E," ",R).
+!show <- ?power(P)[artifact_name(l1)]; ?power(P2)[artifact_name(l2)]; .print(P," ",P2).
