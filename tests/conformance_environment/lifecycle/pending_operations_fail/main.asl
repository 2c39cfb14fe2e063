!go.
+!go <-
  makeArtifact("w","Work",[],Id); focus(Id);
  !!pending(long); !!pending(guarded); !!pending(until_ready); .wait(50);
  disposeArtifact(Id); .wait(50);
  if (working(_)) { .print("still believed") } else { .print("no belief") };
  !late(Id);
  .stopMAS.
+!pending(Op) <- Op; .print("never").
-!pending(Op)[error(E),env_failure_reason(R)] <- .print(Op," ",E," ",R).
+!late(Id) <- long[artifact_id(Id)].
-!late(Id)[error(E),env_failure_reason(R)] <- .print(E," ",R).
