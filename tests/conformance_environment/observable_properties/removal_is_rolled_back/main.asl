!go.
+!go <-
  makeArtifact("r","Rooms",[],Id); focus(Id);
  !try(tidy_up);
  .findall(R,room(R),L); .sort(L,L1); .print("after the failure ",L1);
  clear(hall); .wait(20);
  .findall(R,room(R),L2); .print("after clear ",L2);
  stopFocus(Id); .wait(20);
  .findall(R,room(R),L3); .print("after stopFocus ",L3);
  .stopMAS.
+!try(Op) <- Op.
-!try(Op)[env_failure_reason(R)] <- .print(Op," failed ",R).
-room(R) <- .print("-room ",R).
