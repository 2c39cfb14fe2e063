// A square of one metre, by relative motions.
!square.

+!square
  <- makeArtifact("Wheels", "ArtCmdVel", [turn_speed(120)]);
     for (.range(Corner, 1, 4)) {
       moveForward(1);
       .print("corner ", Corner);
       rotateLeft(90);
     }
     .stopMAS.
