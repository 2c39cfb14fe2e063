// Drives by the robot's navigation, for longer than any test takes.
!drive.

+!drive
  <- .wait(pose(_, _, _));
     navigate_to(38, 0, 0).

-!drive[env_failure_reason(Why)] <- .print("failed ", Why).
