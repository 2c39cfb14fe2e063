!go.
+!go <-
  makeArtifact("n1","Named",["main 1"],A); makeArtifact("n2","Named",["main 2"],B);
  createWorkspace("w"); joinWorkspace("w",W); makeArtifact("n1","Named",["w 1"],C);
  whoami(X1); .print("current: ",X1);
  whoami(X2)[artifact_id(B)]; .print("artifact_id: ",X2);
  whoami(X3)[aid(A)]; .print("aid: ",X3);
  whoami(X4)[wid(W)]; .print("wid: ",X4);
  whoami(X5)[wsp("main")]; .print("wsp: ",X5);
  whoami(X6)[wsp(main)]; .print("wsp atom: ",X6);
  whoami(X7)[wsp("/main")]; .print("wsp path: ",X7);
  whoami(X8)[wsp("main"),artifact_name("n2")]; .print("wsp and name: ",X8);
  whoami(X9)[wid(W),artifact_name("n1")]; .print("wid and name: ",X9);
  whoami(X10)[artifact_id(B),wid(W),artifact_name("n1")]; .print("the id wins: ",X10);
  whoami(X11)[wsp("/main"),artifact_name("n2")]; .print("path and name: ",X11);
  whoami(X12)[artifact_name("n2")]; .print("name alone: ",X12);
  .stopMAS.
