// Tells what it knows of its connection to a topic, and what it hears there.
!begin.

+!begin
  <- makeArtifact("tutorial", "ArtTutorial", [watch_connection(true)], Id);
     focus(Id);
     .print("listening").

+connected(Topic) <- .print("connected ", Topic).
-connected(Topic) <- .print("lost ", Topic).

+chatter("end") <- .stopMAS.
+chatter(Text) : Text \== "" <- .print("heard ", Text).
