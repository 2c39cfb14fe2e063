!go.
+!go <-
  makeArtifact("c","Counter",[],C); focus(C); !show;
  .send(helper,achieve,remove); .wait({-focusing(_,_,_,_,_,_)},2000); .wait(60);
  !show; .stopMAS.
+!show <- .findall(N,focusing(_,N,_,_,_,_),L); .findall(X,count(X),L2); .print("focusing ",L," ",L2).
-count(X) <- .print("-count ",X).
