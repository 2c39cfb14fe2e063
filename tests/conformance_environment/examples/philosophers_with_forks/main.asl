!go.
+!go <- for (.range(I,0,2)) { .concat("fork",I,F); makeArtifact(F,"Fork") };
  .send(philo1,achieve,dine("fork0","fork1",3)); .send(philo2,achieve,dine("fork1","fork2",3)); .send(philo3,achieve,dine("fork0","fork2",3));
  .wait({+all_done}); .wait(50);
  for (.range(I,0,2)) { .concat("fork",I,F); lookupArtifact(F,Id); used(N)[artifact_id(Id)]; .print(F," used ",N) }; .stopMAS.
+done[source(A)] <- +ready(A); if (.count(ready(_),3)) { +all_done }.
