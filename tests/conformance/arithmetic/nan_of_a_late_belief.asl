// NaN is neither less nor greater, wherever the belief that holds it stands.
near(X,Y) :- b(X) & b(Y) & X < Y.
far(X,Y) :- b(X) & b(Y) & X > Y.
!t.
+!t <-
   X = (-1/0) + (1/0); +>b(X); +>b(3); +>b(5);
   .findall(r(V,W), near(V,W), L); .print("near ", L);
   .findall(r(V,W), far(V,W), M); .print("far ", M);
   .findall(r(V,W), (b(V) & b(W) & V < W), K); .print("both ", K);
   if (b(V) & V < 3) { .print(never) } else { .print("none less") };
   .stopMAS.
