// A subscriber of a service is told of its providers, those that are there and those that come.
!start.
+!start
  <- .df_register("paint");
     .df_subscribe("paint");
     .df_subscribe("clean");
     .wait(100);
     .df_register("clean");
     .wait(100);
     .stopMAS.
+provider(A, S)[source(W)] <- .print(A, " ", S, " ", W).
