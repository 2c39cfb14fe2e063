!observe.
+!observe <- !find(Id); focus(Id); focus(Id); ?count(N); .print("focused at ",N).
+!find(Id) <- lookupArtifact("c0",Id).
-!find(Id) <- .wait(20); !find(Id).
+!tell <- .findall(N,count(N),L); .print(L).
+count(N) <- .print("count ",N).
-count(N) : count(M) <- .print("no more ",N," but ",M).
+tick[artifact_name(A)] : count(N) <- .print("tick of ",A," at ",N).
