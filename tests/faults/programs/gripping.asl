// Calls a service of the robot until it succeeds, while the robot drives, and prints the reason of every failure.
!begin.

+!begin
  <- !!drive;
     !grip;
     .wait(arrived);
     .stopMAS.

+!drive
  <- navigate_to(2, 0);
     .print("at 2 0");
     +arrived.

+!grip
  <- open_gripper;
     .print("open").

-!grip[error(E), env_failure_reason(Why)]
  <- .print(E, " ", Why);
     .wait(1000);
     !grip.
