!go.
+!go <-
  makeArtifact("p","Pose",[],Id); focus(Id); .wait(20);
  more; .wait(20); turn(7.5); .wait(20); less; .wait(20); nothing; .wait(20);
  .stopMAS.
+pose <- .print("+pose").
+pose(X) <- .print("+pose ",X).
+pose(X,Y) <- .print("+pose ",X," ",Y).
+pose(X,Y,Z) <- .print("+pose ",X," ",Y," ",Z).
-pose(X,Y) <- .print("-pose ",X," ",Y).
-pose(X,Y,Z) <- .print("-pose ",X," ",Y," ",Z).
-pose(X) <- .print("-pose ",X).
