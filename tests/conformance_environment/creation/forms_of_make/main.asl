!go.
+!go <-
  !t(Id); !u; !v;
  makeArtifact(c,counter_type,[]);
  .stopMAS.
-!go[env_failure_reason(makeArtifactFailure("unknown_artifact_template",_))] <-
  makeArtifact(c,"Counter",[5],Id); focus(Id); ?count(N); .print("made ",N); .stopMAS.
+!t(Id) <- makeArtifact("c","Counter",Id).
-!t(_)[env_failure_reason(wrong_op_arguments(_,Op))] <- .print("wrong \"",Op,"\"").
+!u <- makeArtifact("c","Counter",[],known).
-!u[env_failure_reason(wrong_op_arguments(_,Op))] <- .print("wrong \"",Op,"\"").
+!v <- makeArtifact(3,"Counter").
-!v[env_failure_reason(wrong_op_arguments(_,Op))] <- .print("wrong \"",Op,"\"").
