+!run(N) <- whoami(W0); .print(W0); makeArtifact(N,"Named",["of ann"]); whoami(W); .print(W); lookupArtifact("first",F); focus(F); whoami(W2); .print(W2); whoami(W3)[artifact_id(F)]; .print(W3).
