!go.
+!go <- lookupArtifact("mine",M); put(3)[artifact_id(M)]; stock(N)[artifact_id(M)]; .print("mine is still there with ",N); getCurrentArtifacts(L); .my_name(Me); if (.member("body_victim",L)) { .print("ghost") } else { .print("no ghost") }.
