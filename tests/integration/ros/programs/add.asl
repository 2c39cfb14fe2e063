// Adds with a service that no node serves at first; a second server never answers.
!begin.

+!begin
  <- makeArtifact("Adder", "ArtTutorial", [timeout(1)], Adder);
     makeArtifact("Silent", "ArtTutorial", [timeout(1), service("/silent_add")], Silent);
     !add_at_last(Adder);
     !add(Silent);
     .stopMAS.

+!add_at_last(Artifact) : sum_is_known.
+!add_at_last(Artifact)
  <- !add(Artifact);
     !add_at_last(Artifact).

+!add(Artifact)
  <- sum(20, 22, Sum)[artifact_id(Artifact)];
     +sum_is_known;
     .print("sum ", Sum).

-!add(Artifact)[env_failure_reason(Reason), error_msg(Message)]
  <- .print(Reason, ": ", Message).
