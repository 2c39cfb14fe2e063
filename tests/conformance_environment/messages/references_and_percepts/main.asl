!go.
+!go <-
  createWorkspace("lab"); joinWorkspace("lab",W); makeArtifact("lamp","Lamp",[],Id);
  .send(bob,achieve,use(Id)); .wait(100);
  .send(bob,tell,lamps([Id],W)); .wait(100);
  .send(bob,askOne,mine(_),mine(Other)); brightness(B)[artifact_id(Other)]; .print("bob's has ",B);
  focus(Id); ?lit(L); .print("lit ",L); .send(bob,tell,lit(9)); .wait(60); .send(bob,achieve,tell); .wait(60); .stopMAS.
