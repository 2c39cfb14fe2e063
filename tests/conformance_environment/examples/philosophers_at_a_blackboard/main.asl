!go.
+!go <- for (.range(I,0,4)) { out(fork,I) }; for (.range(I,1,4)) { out(ticket) };
  for (.range(I,1,5)) { .concat("philo",I,S); .term2string(P,S); .send(P,achieve,dine(I-1,(I mod 5),3)) };
  .wait({+all_done}); .wait(50); !forks(5); !tickets(4); .stopMAS.
+done(_) : .count(done(_),5) <- +all_done.
+!forks(N) <- for (.range(I,0,4)) { inp(fork,I) }; .print(N," forks are back").
-!forks(_)[error(E)] <- .print("a fork is missing ",E).
+!tickets(N) <- for (.range(I,1,N)) { inp(ticket) }; .print("all tickets are back"); inp(ticket).
-!tickets(N)[error(E)] <- .print("no further ticket: ",E).
