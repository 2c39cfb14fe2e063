// Prints the state of its connection to a topic, and the messages that it receives there.
!begin.

+!begin
  <- makeArtifact("tutorial", "ArtTutorial", [watch_connection(true)], Id);
     focus(Id);
     .print("listening").

+connected(Topic) <- .print("connected ", Topic).
-connected(Topic) <- .print("lost ", Topic).

+chatter("end") <- .stopMAS.
+chatter(Text) : Text \== "" <- .print("heard ", Text).
