+!watch <- lookupArtifact("b",Id); focus(Id).
+!tell <- ?rung(N); .print("rung ",N).
+ring(N) <- .print("ring ",N).
+rung(N) <- .print("+rung ",N).
