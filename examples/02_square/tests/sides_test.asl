// Tests of robot.asl without a robot: its actions are faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.
+!use_artifact(_, _).

{ include("../robot.asl") }

+!fakes
  <- !fake_action(moveForward(_));
     !fake_action(rotate(_));
     !fake_action(getCurrentPose(1, 0.5, 0));
     !fake_action(.stopMAS);
     +ready.

@has_four_sides[test]
+!test_sides
  <- !fakes;
     !start;
     !assert_did(moveForward(1), 4);
     !assert_did(rotate(90), 4);
     !assert_printed("side 4 done");
     !assert_did(.stopMAS).

@tells_where_it_is[test]
+!test_places
  <- !fakes;
     !start;
     !assert_printed("side 1 done, at 100 cm, 50 cm").
