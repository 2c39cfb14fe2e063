// As listing 21: the battery that a timer drains.
// jacaros: ignore-file singleton-variable

!start.

+!create_battery
  <- makeArtifact("Battery", "jason.architecture.ArtSimBattery", [], BatteryId).

-!create_battery
  <- .print("no battery").

+?toolBattery(BatteryId)
  <- lookupArtifact("Battery", BatteryId).

-?toolBattery(BatteryId)
  <- .wait(10);
     ?toolBattery(BatteryId).

+diagnostics(Diag)
  <- .print(Diag);
     -diagnostics(Diag).

+!start
  <- !create_battery;
     ?toolBattery(BatteryId);
     focus(BatteryId).
