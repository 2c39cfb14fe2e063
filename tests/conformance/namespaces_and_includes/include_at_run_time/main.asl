!start.
+!start
  <- .include("more.asl");
     !hello(1);
     ?colour(C); .print(C);
     .include("more.asl", other);
     !other::hello(2);
     ?other::colour(D); .print(D);
     .include("more.asl", N);
     !N::hello(3);
     .stopMAS.
