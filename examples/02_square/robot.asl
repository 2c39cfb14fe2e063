// A square: four sides of one metre, back to the start and facing the same way.

{ include("$jacaros/artifacts.asl") }

!start.

+!start
  <- // Drives by odometry: an operation ends when the robot has gone the whole way.  Odometry drifts, because
     // wheels slip; with frame(map), localisation corrects it.
     !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map), stop_for(scan)]);
     for (.range(Side, 1, 4)) {
        moveForward(1);  // metres
        rotate(90);      // degrees
        getCurrentPose(X, Y, _);
        .print("side ", Side, " done, at ", math.round(X * 100), " cm, ", math.round(Y * 100), " cm");
        ?(Side < 4 | X * X + Y * Y < 0.05 * 0.05)  // back at the start: otherwise the goal fails
     };
     .stopMAS.

// The robot is lifted, or touches something.
+hazard(Kind, _) : Kind == wheel_drop | Kind == bump <- .fail_goal(start).

-!start <- .print("I am not back at the start, I need help"); .stopMAS(0, 1).
