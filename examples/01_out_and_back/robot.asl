// Out and back: drive ahead for a while, turn around, drive back for the same time, turn around again.

// Plans that come with JaCaROS, including use_artifact.
{ include("$jacaros/artifacts.asl") }

// The initial goal of the agent: achieve `start`.
!start.

// A plan: to achieve the goal `start`, run these steps in order.
+!start
  <- // An artifact is something that the agent uses; this one drives the robot.
     !use_artifact("wheels", "ArtCmdVel", [frame(map)]);
     for (.member(Leg, [out, back])) {
        .print("driving ", Leg);
        move(25);     // drive ahead for 2.6 seconds: 26 commands at 10 Hz
        rotate(180);  // degrees, to the left; ends when odometry has measured them
     };
     getCurrentPose(X, Y, _Heading);  // capitalised names are variables: they get their values here
     .print("I believe to be ", math.round(1000 * math.sqrt(X * X + Y * Y)),
            " mm from where I started");
     .stopMAS.  // stop the whole system
