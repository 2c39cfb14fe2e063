!start.

+!start
  <- ?speed(Speed);
     ?places(Places);
     ?pace(Pace);
     .print("begins with ", Speed, " ", Places, " ", Pace).

+speed(0.75)
  <- .print("faster");
     slower;
     .wait(speed(0.1));
     .print("slower").

+places([kitchen, _])
  <- .print("elsewhere").

+speed(0.5)
  <- .print("ends");
     .stopMAS.
