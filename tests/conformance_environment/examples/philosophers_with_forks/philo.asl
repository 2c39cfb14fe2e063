+!dine(L,R,N) <- lookupArtifact(L,Left); lookupArtifact(R,Right); !eat(Left,Right,N); .send(main,tell,done).
+!eat(_,_,0) <- .print("full").
+!eat(L,R,N) <- grab[artifact_id(L)]; grab[artifact_id(R)]; .print("eats ",N); .wait(10);
  drop[artifact_id(R)]; drop[artifact_id(L)]; !eat(L,R,N-1).
