!go.
+!go <-
  makeArtifact("s","Server",[],Id); focus(Id); .wait(100);
  !!ask(a,100); !!ask(b,10); !!ask(c,50); !!ask(d,1); .wait(100); .send(bob,achieve,ask(x)); .wait(700);
  report(L); .print(L); .stopMAS.
+!ask(Who,Ms) <- serve(Who,Ms,N); .print(Who," was number ",N).
+served(N,Who) <- .print("served ",N," ",Who).
