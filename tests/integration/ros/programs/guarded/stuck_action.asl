// Drives until its process hangs in a step that never ends.
{ include("action.asl") }
!hang.

+!hang
  <- .wait(8000);
     makeArtifact("trap", "Trap", []);
     hang.
