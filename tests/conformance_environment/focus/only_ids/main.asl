!go.
+!go <-
  makeArtifact("c","Counter",[],C);
  !t("focus string"); !t("focus atom"); !t("stopFocus string");
  focus(C); ?count(N); .print("by id ",N);
  .stopMAS.
+!t("focus string") <- focus("c").
+!t("focus atom") <- focus(c).
+!t("stopFocus string") <- stopFocus("c").
-!t(N)[error(action_failed),env_failure_reason(wrong_op_arguments(_,Op))] <- .print(N," wrong_op_arguments \"",Op,"\"").
