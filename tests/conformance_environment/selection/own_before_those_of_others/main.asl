!go.
+!go <- makeArtifact("first","Named",["of main"]); .wait(60); .send(ann,achieve,run("a")); .wait(60); .send(bob,achieve,run("b")); .wait(60);
  .send(eve,achieve,look); .wait(100); whoami(W); .print(W); .stopMAS.
