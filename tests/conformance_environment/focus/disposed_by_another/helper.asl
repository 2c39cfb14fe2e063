+!remove <- lookupArtifact("c",C); disposeArtifact(C).
