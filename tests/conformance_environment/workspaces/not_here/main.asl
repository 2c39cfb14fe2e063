!go.
+!go <- !t(1); !t(2); !t(3); !t(4); !t(5); .stopMAS.
+!t(1) <- createWorkspace("w","localhost:20100").
+!t(2) <- createWorkspaceWithTopology("w","grid").
+!t(3) <- linkRemoteWorkspace("/main/w","web","w").
+!t(4) <- mountWorkspace("http://localhost:20100","/main/w","w").
+!t(5) <- spawnNode("n").
-!t(_)[error(action_failed),env_failure_reason(R)] <- .print(R).
