// An agent that registers a service is found until it deregisters; with the directory comes an agent df.
!start.
+!start
  <- .all_names(Before); .length(Before, N1); .print(N1);
     .df_register("sell(book)");
     .df_search("sell(book)", L1); .print(L1);
     .df_search("sell(car)", L2); .print(L2);
     .df_deregister("sell(book)");
     .df_search("sell(book)", L3); .print(L3);
     .all_names(After); .length(After, N2); .print(N2);
     if (.member(df, After)) { .print("df is there") };
     .stopMAS.
