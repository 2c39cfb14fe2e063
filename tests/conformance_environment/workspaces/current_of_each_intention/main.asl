!go.
+!go <-
  makeArtifact("n","Named",[main]); createWorkspace("w1"); createWorkspace("w2");
  !ask(0);
  !!in_w1; .wait(60); !ask(1);
  joinWorkspace("/main/w2",_); makeArtifact("n","Named",["w2"]); !ask(2);
  !!ask(fresh); .wait(60);
  !inside; !ask(after_inside);
  joinWorkspace("/main"); !ask(3);
  !!ask(fresh_again); .wait(60);
  whoami(N)[wsp("w1")]; .print("directed ",N); !ask(4); .wait(100); .stopMAS.
+!in_w1 <- joinWorkspace("w1",_); makeArtifact("n","Named",["w1"]); !ask(in_w1); .wait(250); !ask(still_in_w1); joinWorkspace("../w2"); !ask(moved).
+!inside <- joinWorkspace("../w1"); !ask(inside).
+!ask(X) <- whoami(N); .print(X," ",N).
