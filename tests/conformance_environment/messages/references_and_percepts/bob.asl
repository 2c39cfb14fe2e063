+!use(Id) <- switch(1)[artifact_id(Id)]; .print("not reached").
-!use(Id)[error(E)] <- .print("not there yet: ",E); joinWorkspace("lab",_); switch(1)[artifact_id(Id)]; .print("switched"); joinWorkspace("/main").
+lamps([Id],W) <- focus(Id); ?lit(N); .print("lit ",N); lookupArtifact("lamp",Same)[wid(W)]; if (Same == Id) { .print("the same") };
  makeArtifact("lamp","Lamp",[],Mine); switch(5)[artifact_id(Mine)]; +mine(Mine).
+!tell <- .findall(N,lit(N)[source(percept)],P); .findall(N,lit(N)[source(main)],M); .print(P," ",M).
+lit(N)[source(percept)] <- .print("perceived ",N).
+lit(N)[source(main)] <- .print("told ",N).
