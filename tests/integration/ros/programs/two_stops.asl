// Drives to two stops from any start: one program for robots of any name.
{ include("$jacaros/navigation.asl") }

!start.

+!start
  <- .wait(pose(X, Y, _));
     clear_costmaps;
     !go_to(X + 1, Y, 0);
     !go_to(X + 1, Y + 0.4, 90);
     .print("is there");
     .stopMAS.
