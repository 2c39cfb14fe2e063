!go.
+!go <-
  makeArtifact("b","cartago.tools.Barrier",[2]); +made;
  hit; .print("arrived"); +at(1); .send(other,tell,go); waitForAll; .wait(100); .print("on 1"); .stopMAS.
