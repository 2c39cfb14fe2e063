// A square: four sides of one metre, back to where and how the robot stood at the beginning.

{ include("$jacaros/artifacts.asl") }

!start.

+!start
  <- // Drives by odometry: an operation ends when the robot has come as far as it was told to.  With frame(map)
     // localisation puts odometry right, which drifts, as wheels slip.
     !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map)]);
     for (.range(Side, 1, 4)) {
        moveForward(1);  // metres
        rotate(90);      // degrees
        getCurrentPose(X, Y, _);
        .print("side ", Side, " done, at ", math.round(X * 100), " cm, ", math.round(Y * 100),
               " cm")
     };
     .stopMAS.
