// A battery runs down from 100 to 0 percent, and the agent reports its state.

{ include("$jacaros/artifacts.asl") }

!start.

// The project file robot_battery.jcm gives the agent the belief battery_source(robot).
+!start : battery_source(Source)
  <- !use_artifact("battery", "ArtSimBattery", [source(Source)]).

// Without this belief, a timer drains the battery by one percent per second.
+!start
  <- !use_artifact("battery", "ArtSimBattery").

// The artifact has the observable properties battery(Percent) and diagnostics(Text).  They become beliefs of the
// agent, and a plan that begins with +diagnostics runs whenever the text changes.
+diagnostics(Text) : battery(Percent)
  <- .print(Percent, " %: ", Text).

+battery(0)
  <- .print("0 %: empty");
     .stopMAS.
