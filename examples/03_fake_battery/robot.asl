// A battery runs down from 100 to 0 percent, and the agent tells what it thinks of it.

{ include("$jacaros/artifacts.asl") }

// Where the battery comes from: a timer that takes one percent a second.  The project file
// robot_battery.jcm says `robot` instead: then it is the robot's own.
battery_source(timer).

!start.

+!start : battery_source(Source)
  <- !use_artifact("battery", "ArtSimBattery", [source(Source)]).

// The artifact shows battery(Percent) and diagnostics(Text).  The agent believes what it sees, and a
// plan that begins with +diagnostics runs whenever there is a new one.
+diagnostics(Text) : battery(Percent)
  <- .print(Percent, " %: ", Text).

+battery(0)
  <- .print("0 %: empty");
     .stopMAS.
