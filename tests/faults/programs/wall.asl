// Drives against a wall.
!start.

+!start
  <- makeArtifact("wheels", "ArtCmdVelAndOdometry", [], Id);
     focus(Id);
     !forth.

+!forth <- moveForward(3).
