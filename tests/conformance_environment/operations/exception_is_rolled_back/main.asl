!go.
+!go <-
  makeArtifact("m","Machine",[],Id); focus(Id);
  !try(break_down); ?parts(N); .print("parts ",N);
  !try(late); ?parts(N2); .print("parts ",N2);
  start_process; .wait(50); ?parts(N3); .print("parts ",N3);
  add; ?parts(N4); .print("parts ",N4);
  .stopMAS.
+!try(Op) <- Op.
-!try(Op)[error(E),env_failure_reason(R)] <- .print(E," ",R).
+parts(N) <- .print("+parts ",N).
