// Out and back: drive ahead for a while, turn around, come back by the same time, turn around again.

// Plans that come with jacaros, among them use_artifact.
{ include("$jacaros/artifacts.asl") }

// The first goal of the agent: it wants to `start`.
!start.

// A plan: to reach the goal `start`, do these steps in turn.
+!start
  <- // An artifact is a thing that the agent uses; this one drives the robot.
     !use_artifact("wheels", "ArtCmdVel", [frame(map)]);
     for (.member(Leg, [out, back])) {
        .print("driving ", Leg);
        move(25);     // drive ahead for 2.6 seconds: 26 commands, ten a second
        rotate(180);  // degrees, to the left; ends when odometry says so
     };
     getCurrentPose(X, Y, _Heading);  // names with a capital are variables: they get their values here
     .print("I believe to be ", math.round(1000 * math.sqrt(X * X + Y * Y)),
            " mm from where I started");
     .stopMAS.  // end the whole system
