!go.
+!go <-
  focusWhenAvailable("c"); ?count(N); .print("focused ",N);
  focusWhenAvailable(c); ?count(M); .print("at once ",M);
  !late;
  .stopMAS.
+!late <- focusWhenAvailable("d")[timeout(300)].
-!late[env_failure_reason(R)] <- .print("gave up ",R).
