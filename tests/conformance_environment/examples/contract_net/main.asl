!go.
+!go <- makeArtifact("tasks","TaskBoard",[],Id); .wait(200);
  announce("paint","cnp_paint"); lookupArtifact("cnp_paint",Cnp); focus(Cnp);
  getBids(Bids)[artifact_id(Cnp)]; .length(Bids,N); .print(N," bids");
  .findall(o(P,A,I),.member([I,A,P],Bids),Offers); .min(Offers,o(Price,Who,Number));
  award(Number)[artifact_id(Cnp)]; .print("to ",Who," for ",Price); .wait(100); .stopMAS.
+state(S) <- .print("state ",S).
