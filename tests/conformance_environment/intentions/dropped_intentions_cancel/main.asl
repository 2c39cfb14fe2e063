!go.
+!go <-
  makeArtifact("o","Oven",[],Id); focus(Id); .wait(60);
  !!bake(cake); .wait(100); .drop_intention(bake(_)); .wait(60); .print("dropped");
  !!bake(bread); .wait(60); !!bake(rolls); .wait(60); .drop_desire(bake(rolls)); .wait(60); ?oven(S); .print("oven ",S);
  .wait(800); baked(L); .print(L);
  !!outer; .wait(60); .succeed_goal(inner); .wait(60); baked(L2); .print(L2); .stopMAS.
+!bake(What) <- .print("bakes ",What); bake(What,500); .print("has ",What).
+!outer <- .print("outer"); !inner; .print("outer goes on").
+!inner <- bake(pie,500); .print("not reached").
+oven(S) <- .print("now ",S).
