!start.
+!start
  <- .kill_agent(worker, 400);
     .wait(900);
     .all_names(L); .print(L);
     .stopMAS.
