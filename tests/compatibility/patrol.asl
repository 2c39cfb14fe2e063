// As listings 22 and 23: patrol and recharge, all moves relative.

{ include("$jacaros/artifacts.asl") }  /* plans for ArtSimBattery and ArtCmdVelMuxAndOdometry */

!start.

+!patrol
  <- .print("side");
     moveForward(2);
     rotate(90);
     !!patrol.  // recursive

+!start
  <- !create_cmd_vel_mux_odom;
     ?toolCmd_vel_mux_odom(CmdVelMuxId);
     focus(CmdVelMuxId);

     !create_battery;
     ?toolBattery(BatId);
     focus(BatId);
     !patrol.

+diagnostics(Diag) : Diag = "Full Battery"
  <- .print("Current Diagnostic: ", Diag);
     -diagnostics(Diag).

+diagnostics(Diag) : Diag = "Medium Battery"
  <- .print("Current Diagnostic: ", Diag);
     -diagnostics(Diag).

+diagnostics(Diag) : Diag = "Low Battery"
  <- .print("Current Diagnostic: ", Diag);
     -diagnostics(Diag);
     .suspend(patrol);
     !recharge.

+!recharge
  <- moveForward(1);
     rotate(90);
     moveForward(1);
     .print("recharging");
     operationRecharge;
     !return.

+!return
  <- rotate(180);
     moveForward(1);
     rotate(-90);
     moveForward(1);
     rotate(180);
     .print("returned");
     .resume(patrol).
