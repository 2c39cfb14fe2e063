// As listings 24 and 25: the patrol with a household.
// jacaros: ignore-file singleton-variable

{ include("$jacaros/artifacts.asl") }  /* plans for ArtSimBattery and ArtCmdVelMuxAndOdometry */

!start.

+!create_household
  <- makeArtifact("Household", "jason.architecture.ArtCleaning", [], HouseholdId).

-!create_household
  <- .print("no household").

+?toolHousehold(HouseholdId)
  <- lookupArtifact("Household", HouseholdId).

-?toolHousehold(HouseholdId)
  <- .wait(10);
     ?toolHousehold(HouseholdId).

+!patrol
  <- moveForward(2);
     rotate(90);
     !cleanRoom;  // clean
     !!patrol.

+!start
  <- !create_cmd_vel_mux_odom;
     ?toolCmd_vel_mux_odom(CmdVelMuxId);
     focus(CmdVelMuxId);
     !create_battery;
     ?toolBattery(BatId);
     focus(BatId);
     !create_household;
     ?toolHousehold(HouseholdId);
     focus(HouseholdId);
     !patrol.

+vacuum(Object, Room)
  <- .print("At: ", Room);
     .println("Vacuum ", Object);
     -vacuum(Object, Room).

+mop(Object, Room)
  <- .print("At ", Room);
     .println("Mop ", Object);
     -mop(Object, Room).

+scrub(Object, Room)
  <- .print("At ", Room);
     .println("Scrub ", Object);
     -scrub(Object, Room).

+!cleanRoom
  <- -atRoom(Any);
     updateWhereAmI;  // the next room
     ?atRoom(Y);
     clean(Y);  // its tasks
     rotate(-5);
     rotate(10);
     rotate(-5);
     .wait(1000).

+diagnostics(Diag) : Diag = "Low Battery"
  <- .print("Current Diagnostic: ", Diag);
     -diagnostics(Diag);
     .suspend(patrol);
     .suspend(cleanRoom);
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
     .resume(cleanRoom);
     .resume(patrol).
