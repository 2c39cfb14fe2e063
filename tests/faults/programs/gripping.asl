// Asks a service of the robot until it does what it should, while the robot drives; tells every reason.
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
