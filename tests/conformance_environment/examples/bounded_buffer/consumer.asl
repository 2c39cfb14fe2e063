last(producer1,0). last(producer2,0).
+begin <- !consume.
+!consume <- get(P,N); ?last(P,M); if (N <= M) { .print("overtaken: ",P," ",N," after ",M) }; -last(P,M); +last(P,N);
  .send(main,tell,item(P,N)); !!consume.
