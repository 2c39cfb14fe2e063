// Out and back: drive ahead for a while, turn around, drive back for the same time, turn around again.

// Plans that come with JaCaROS, including use_artifact.
{ include("$jacaros/artifacts.asl") }

// The initial goal of the agent: achieve `start`.
!start.

// A plan: to achieve the goal `start`, run these steps in order.
+!start
  <- !use_artifact("wheels", "ArtCmdVel", [frame(map), stop_for(scan)]);  // an artifact is something that the agent uses
     // move(25) drives ahead for 2.6 seconds, with 26 commands at 10 Hz; rotate turns to the left, by degrees, and
     // ends when odometry has measured them.
     for (.member(Leg, [out, back])) { .print("driving ", Leg); move(25); rotate(180) };
     // Wheels slip, so look where that has led: capitalised names are variables, which get their values here.
     getCurrentPose(Ahead, _, _);
     moveForward(-Ahead);
     getCurrentPose(X, Y, _);
     .print("I believe to be ", math.round(1000 * math.sqrt(X * X + Y * Y)), " mm from where I started");
     X * X + Y * Y < 0.05 * 0.05;  // a condition is a step, too: if it does not hold, the goal fails
     .stopMAS.                     // stop the whole system

// The robot is lifted or touches something: what it has measured is worth nothing.
+hazard(Kind, _) : Kind == wheel_drop | Kind == bump <- .fail_goal(start).

// The goal has failed: the exit status says so.
-!start <- .print("I am not where I started, I need help"); .stopMAS(0, 1).
