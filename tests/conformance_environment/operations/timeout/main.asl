!go.
+!go <-
  makeArtifact("s","Slow",[],S); focus(S);
  !late; .wait(700); .findall(X,begun(X),L); .print("cancelled ",L);
  !waiting;
  slow[timeout(800)]; .findall(X,done(X),L2); .print("in time ",L2);
  !!other; .wait(100); .drop_intention(other); .wait(700); .findall(X,begun(X),L3); .print("dropped ",L3);
  .stopMAS.
+!late <- slow[timeout(200)].
-!late[env_failure_reason(R)] <- .print("late ",R).
+!waiting <- guarded[timeout(100)].
-!waiting[env_failure_reason(R)] <- .print("waiting ",R).
+!other <- slow; .print("not dropped").
+done(X) : X == 3 <- .print("went on").
