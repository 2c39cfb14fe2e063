!go.
+!go <-
  makeArtifact("n","Navigator",[],Id); focus(Id);
  drive(pose(1,2),fast); .wait(20);
  drive(pose(1,2.5,"odom"),slow); .wait(20);
  path([pose(0,0),pose(3,4)],L); .print(L);
  !try(drive(pose(1,a),fast)); !try(drive(pose(1,2),backwards)); !try(path([pose(1)],_));
  mean([1,2,6],M); .print(M);
  .stopMAS.
+goal(P,S) <- .print("goal ",P," ",S).
+!try(Op) <- Op; .print("never").
-!try(Op)[env_failure_reason(wrong_op_arguments(_,K))] <- .print(K).
