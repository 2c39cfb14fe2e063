!go.
+!go <-
  createWorkspace("w"); joinWorkspace("w",W); makeArtifact("n","Named",["in w"],N); quitWorkspace(W); joinWorkspace("/main",_);
  !try(fly(3,"x")); !try(fly); !try(left::fly(1.5));
  !try(id(N)); !try(wid(W)); !try(wsp("nowhere"));
  !try(unknown(height(2)));
  !misfit; .stopMAS.
+!try(fly(A,B)) <- fly(A,B).
+!try(fly) <- fly.
+!try(left::fly(A)) <- left::fly(A).
+!try(id(N)) <- whoami(_)[artifact_id(N)].
+!try(wid(W)) <- whoami(_)[wid(W)].
+!try(wsp(W)) <- whoami(_)[wsp(W)].
+!try(unknown(A)) <- makeArtifact("here","Named",["here"],_); both(x)[A].
-!try(_)[error(E),env_failure_reason(R)] <- .print(E," ",R).
+!misfit <- two(X,X); .print("not reached ",X).
-!misfit[error(E),env_failure_reason(R)] <- .print(E," ",R).
