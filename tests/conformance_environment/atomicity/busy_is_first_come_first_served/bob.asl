+!ask(Who) <- serve(Who,1,N); .print(Who," was number ",N).
