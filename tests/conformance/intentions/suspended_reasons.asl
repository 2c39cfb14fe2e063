// The reason of a suspended goal is suspend_ia; one that waits is reported with what it waits for.
!start.
+!start <- !!run; .suspend(run); !!timed; !!self; .wait(60); .suspend(timed);
  for (.member(G, [timed, self, run])) { if (.suspended(G, wait(_)[time(M)])) { .print(G, " waits ", M) } else { .suspended(G, R); .print(G, " ", R) } };
  .stopMAS.
+!run <- .print("run").
+!timed <- .wait(150); .print("timed").
+!self <- .suspend; .print("self").
