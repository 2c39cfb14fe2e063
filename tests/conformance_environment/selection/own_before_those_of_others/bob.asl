+!run(N) <- makeArtifact(N,"Named",["of bob"],Id); lookupArtifact("a",A); focus(A); whoami(W); .print(W); disposeArtifact(Id); whoami(W2); .print(W2); stopFocus(A); whoami(W3); .print(W3).
