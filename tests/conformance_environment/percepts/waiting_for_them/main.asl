!go.
+!go <-
  makeArtifact("k","Stove",[],Id); focus(Id); .wait(60);
  heat(3); .wait(heat(3)); .print("was so already");
  !!later(5); .wait(heat(N) & N >= 5); ?heat(N2); .print("now ",N2);
  !!later(9); .wait({+boils(_)}); .print("boils");
  .wait(heat(1),80,T); if (T >= 80) { .print("gave up") } else { .print("?") };
  !late; .stopMAS.
+!later(N) <- .wait(60); heat(N).
+!late <- .wait({+boils(_)},80); .print("not reached").
-!late[error(E)] <- .print("late: ",E).
