!go.
+!go <- makeArtifact("r","Rendezvous",[3]); .wait(100); .broadcast(achieve,meet(1)); !meet(1); .wait(60); !meet(2); .wait(60); .stopMAS.
+!meet(Round) : .my_name(Me) <- .print("comes ",Round); meet(Me,Others); .length(Others,N); .sort(Others,S); .print("met ",N,": ",S).
