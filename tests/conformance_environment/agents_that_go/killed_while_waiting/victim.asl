+!work <- lookupArtifact("s",Id); focus(Id); makeArtifact("mine","Shop",[],M); ring("made"); !!second(Id); take(N)[artifact_id(Id)]; .print("not reached ",N).
+!second(Id) <- .print("waits too"); take(N)[aid(Id)]; .print("not reached either ",N).
+sound(X) <- .print("heard ",X).
