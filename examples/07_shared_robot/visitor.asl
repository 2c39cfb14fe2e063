// The visitor: while the patrol is on the far side of the room, it moves into the path and stays there for a while.

+visits(2)
  <- driveTo(1, 0)[artifact_name("legs")];
     .print("what a nice room");
     .wait(20000);
     driveTo(1, -0.9)[artifact_name("legs")].
