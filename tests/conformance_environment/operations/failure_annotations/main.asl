!go.
+!go <- makeArtifact("f","Failing"); !quiet[mine]; !loud; !wrong; .stopMAS.
+!quiet <- quiet(1).
-!quiet[error(E),code(C),code_line(L),source(S),mine|R] <-
  .print(E," ",C," ",L," ",S); if (.member(env_failure_reason(X),R)) { .print("reason ",X) } else { .print("no reason") };
  if (.member(error_msg(M),R)) { .print(M) }.
+!loud <- loud.
-!loud[error(E),error_msg(M),env_failure_reason(too_loud(N,T)),code(C),code_line(L)] <- .print(E," ",M," ",N," ",T," ",C," ",L).
-!loud[too_loud(_,_)] <- .print("not as a bare tuple").
+!wrong <- quiet(x).
-!wrong[env_failure_reason(wrong_op_arguments(_,Op)),code(C)] <- .print(Op," ",C).
