!go.
+!go <-
  makeArtifact("o","Odd",[],Id); focus(Id);
  ?value(nan,A); ?value(up,B); ?value(down,C); ?value(huge,D); ?value(none,E); .print(A," ",B," ",C," ",D," ",E);
  if (B > 1.0e300 & C < -1.0e300) { .print(ordered) };
  .stopMAS.
