!go.
+!go <- .wait(200); .print("making"); makeArtifact("c","Counter",[3]).
