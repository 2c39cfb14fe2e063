!go.
+!go <-
  makeArtifact("g","Tray",[],Id); .wait(60);
  .send(ann,achieve,want(1)); .wait(40); .send(bob,achieve,want(2)); .wait(40); !!want(1); .wait(40); !!want(1); .wait(40); .send(ann,achieve,want(1)); .wait(40);
  add(1); .wait(40); add(1); .wait(40); add(1); .wait(40); add(2); .wait(40); add(1); .wait(40);
  notes(L); .print(L); .stopMAS.
+!want(N) : .my_name(Me) <- take(Me,N); .print("took ",N).
