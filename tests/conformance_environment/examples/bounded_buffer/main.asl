!go.
+!go <- makeArtifact("buffer","Buffer",[3],Id); .wait(100);
  .send([producer1,producer2],tell,begin); .send([consumer1,consumer2,consumer3],tell,begin);
  .wait({+full_account}); .wait(50);
  account(Put,Got,Most,Order); .print("put ",Put,", got ",Got,", at most ",Most," inside, in order: ",Order);
  .findall([P,N],item(P,N),L); .length(L,K); .print(K," different items"); .stopMAS.
+item(P,N)[source(C)] : .count(item(_,_),20) <- +full_account.
