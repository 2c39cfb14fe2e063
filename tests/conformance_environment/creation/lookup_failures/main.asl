!go.
+!go <-
  makeArtifact("c","Counter",[],C); disposeArtifact(C);
  .print("no reason is missing");
  !t(lookup,C); !t(type,C); !t(dispose,C); !t(focus,C); !t(stopFocus,C); !t(id,C); !t(bound,C);
  .stopMAS.
+!t(lookup,_) <- lookupArtifact("d",_).
+!t(type,_) <- lookupArtifactByType("Lamp",_).
+!t(dispose,C) <- disposeArtifact(C).
+!t(focus,C) <- focus(C).
+!t(stopFocus,C) <- stopFocus(C).
+!t(id,_) <- disposeArtifact("c").
+!t(bound,C) <- lookupArtifact("console",C).
-!t(N,_)[error(action_failed),env_failure_reason(wrong_op_arguments(_,Op))] <- .print(N," wrong_op_arguments \"",Op,"\"").
-!t(N,_)[error(action_failed),env_failure_reason(R)] <- .print(N," ",R).
-!t(N,_)[error(E)] <- .print(N," failed without a reason ",E).
