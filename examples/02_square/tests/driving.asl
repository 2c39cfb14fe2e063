// Tests in a simulated world; test_driving.jcm selects the world.

{ include("$jacaros/tester_agent.asl") }

{ include("$jacaros/artifacts.asl") }

@a_square_ends_where_it_began[test]
+!test_square
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
     for (.range(_, 1, 4)) {
        moveForward(1);
        rotate(90)
     };
     getCurrentPose(X, Y, _);
     !assert_equals(0, X, 0.05);
     !assert_equals(0, Y, 0.05).

@a_half_turn_and_a_metre_lead_back[test]
+!test_back
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
     moveForward(1);
     getCurrentPose(Out, _, _);
     !assert_between(Out, 0.95, 1.05);
     rotate(180);
     moveForward(1);
     getCurrentPose(Back, _, _);
     !assert_equals(0, Back, 0.05).
