// A battery runs down from 100 to 0 percent, and the agent tells what it thinks of it.

{ include("$jacaros/artifacts.asl") }

!start.

// The project file robot_battery.jcm gives the agent the belief battery_source(robot).
+!start : battery_source(Source)
  <- !use_artifact("battery", "ArtSimBattery", [source(Source)]).

// Without such a belief it is a battery that a timer drains, one percent a second.
+!start
  <- !use_artifact("battery", "ArtSimBattery").

// The artifact shows battery(Percent) and diagnostics(Text).  The agent believes what it sees, and a
// plan that begins with +diagnostics runs whenever there is a new one.
+diagnostics(Text) : battery(Percent)
  <- .print(Percent, " %: ", Text).

+battery(0)
  <- .print("0 %: empty");
     .stopMAS.
