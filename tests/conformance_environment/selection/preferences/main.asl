!go.
+!go <-
  makeArtifact("shared","Named",["made first"]); .send(other,achieve,look); .wait(100);
  createWorkspace("w"); joinWorkspace("w",_); whoami(X); .print("home: ",X);
  makeArtifact("near","Named",["in w"]); whoami(Y); .print("current: ",Y);
  !!elsewhere; .wait(50); !sub; whoami(Z); .print("after the sub-goal: ",Z);
  .stopMAS.
+!elsewhere <- whoami(X); .print("another intention: ",X).
+!sub <- joinWorkspace("/main",_); whoami(X); .print("sub-goal: ",X).
