!start.
+!start
  <- ++news(1);
     .wait(100);
     .add_plan({ +news(X) <- .print(X) });
     .wait(100);
     .my_name(N);
     if (N == keeper) { .wait(100); .stopMAS }.
