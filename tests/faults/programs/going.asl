// Goes to two places with the plan library, which recovers from failed drives.
{ include("$jacaros/navigation.asl") }

place(far, 2, 0, 0).
place(home, 0, 0, 0).

!begin.

+!begin
  <- !go_to(far);
     .print("far");
     !go_to(home);
     .print("home");
     .stopMAS.
