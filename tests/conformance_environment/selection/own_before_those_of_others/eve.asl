+!look <- whoami(W); .print(W); lookupArtifact("a",A); focus(A); lookupArtifact("first",F); focus(F); whoami(W2); .print(W2); stopFocus(A); whoami(W3); .print(W3).
