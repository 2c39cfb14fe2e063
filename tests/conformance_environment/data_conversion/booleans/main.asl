!go.
+!go <- makeArtifact("t","Tester",[],Id); focus(Id); .wait(60);
  even(4,A); if (A) { .print("4 is even") } else { .print("4 is odd") };
  even(3,B); if (B == true) { .print("3 is even") } else { .print("3 is odd") };
  even(8,C); C = true; .print("C is ",C);
  !same(false); !same(true); negate(true,D); negate(D,E); .print(D," ",E); .wait(60);
  ?last(E); .print("the last is ",E); .stopMAS.
+!same(X) <- even(6,R); X = R; .print("6 is even: ",X).
-!same(X) <- .print("6 is even is not ",X).
+last(true) <- .print("last true").
+last(false) <- .print("last false").
