+!make <- makeArtifact("second","Named",["second"]); makeArtifact("third","Named",["third"]).
