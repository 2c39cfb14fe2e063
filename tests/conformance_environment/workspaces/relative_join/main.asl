!go.
+!go <-
  createWorkspace("w1"); createWorkspace("w2"); createWorkspace("w1/w2");
  joinWorkspace("w1"); joinWorkspace("w2",A); ?joinedWsp(A,_,P); .print("\"",P,"\"");
  joinWorkspace("/main/w2",B); ?joinedWsp(B,_,Q); .print("\"",Q,"\"");
  !t(unknown); !t(exists);
  .stopMAS.
+!t(unknown) <- joinWorkspace("w7").
+!t(exists) <- createWorkspace("/main/w1").
-!t(N)[error(E)] <- .print(N," ",E).
