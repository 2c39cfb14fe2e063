!go.
+!go <-
  makeArtifact("k","cartago.tools.Clock",[],K); focus(K); ?nticks(N); .print("nticks ",N);
  setFrequency(10); start; .wait(250); stop; .wait(300);
  ?nticks(M); .print("stopped ",M);
  .stopMAS.
+tick : nticks(N) <- .print("tick ",N).
