!go.
+!go <-
  makeArtifact("o","Once",[],Id); focus(Id);
  use(R); .print("used ",R);
  .wait(50);
  if (uses(_)) { .print("still believed") } else { .print("no belief") };
  !again;
  makeArtifact("o","Once",[],Id2); use(R2); .print("used ",R2);
  .stopMAS.
+!again <- lookupArtifact("o",_); .print("never").
-!again <- .print("gone").
-uses(N) <- .print("-uses ",N).
