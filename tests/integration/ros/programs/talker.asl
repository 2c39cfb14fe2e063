// Repeatedly prints, logs, and fails a goal; also receives messages.

!talk.

+!talk
  <- makeArtifact("ros", "ArtRos", [], Id);
     focus(Id);
     makeArtifact("odo", "ArtOdometry", [watch_connection(true)], Odo);
     focus(Odo);
     !again.

+!again
  <- .print("hello graph");
     rosout(error, "by the artifact");
     !!impossible;
     .wait(300);
     !again.

+!impossible
  <- .fail.

+connected(Topic)
  <- .print("hears ", Topic).
