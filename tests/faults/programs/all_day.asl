// Patrols, is suspended and dropped in the middle of goals, calls services, and creates and disposes artifacts, repeatedly.
{ include("$jacaros/artifacts.asl") }
{ include("$jacaros/navigation.asl") }

place(a, 2, 0, 0).
place(b, 2, 2, 90).
place(nowhere, 50, 50, 0).
attempts(2).

!begin.

+!begin
  <- .wait(pose(_, _, _));
     !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [mode(verbose), watch_connection(1)]);
     !use_artifact("scan", "ArtBaseScan");
     !!patrol([a, b, nowhere]);
     !!disturb;
     !!visitors.

+!disturb
  <- .wait(7000);
     .suspend(patrol(_));
     .wait(2000);
     .resume(patrol(_));
     .wait(5000);
     .suspend(patrol(_));
     !turn;
     .drop_desire(patrol(_));
     !!patrol([a, b, nowhere]);
     clear_costmaps;
     !disturb.

+!turn <- rotate(90).
-!turn.

+!visitors
  <- makeArtifact("visitor", "ArtOdometry", [], Id);
     focus(Id);
     .wait(2000);
     disposeArtifact(Id);
     makeArtifact("guest", "turtlebot4.yaml", ["robot_7"], Other);
     focus(Other);
     !hurry;
     disposeArtifact(Other);
     !visitors.

// No server exists for this artifact, so it waits and is cancelled.
+!hurry
  <- dock.

-!hurry.
