!go.
+!go <-
  makeArtifact("c","Counter",[],C);
  focus(C,count(2));
  inc; inc; !show;
  stopFocus(C); focus(C,[tick]); +listening;
  inc; .wait(60); !show;
  .print("done"); .stopMAS.
+!show <- .findall(X,count(X),L); .findall(X,label(X),L2); .print("beliefs ",L," ",L2).
+tick(N) : listening <- .print("tick ",N).
+tick(N) <- .print("unwanted tick ",N).
