// Tests of robot.asl without a robot: its actions are faked.  Run them with `jacaros test legs_test.asl`.

{ include("$jacaros/tester_agent.asl") }

// Plans before an include override the plans of the included file.
+!start : not ready.   // the initial goal of robot.asl does nothing until a test is ready
+!use_artifact(_, _).  // no wheels

{ include("../robot.asl") }

// A plan with `test` in its label is a test.
@drives_out_and_back[test]
+!test_legs
  <- !fake_action(move(_));
     !fake_action(rotate(_));
     !fake_action(getCurrentPose(0.03, 0.04, 0));  // the pose that the fake returns
     !fake_action(.stopMAS);
     +ready;
     !start;
     !assert_did(move(25), 2);
     !assert_did(rotate(180), 2);
     !assert_printed("driving out");
     !assert_printed("driving back");
     !assert_did(.stopMAS).

@tells_how_far_it_is_off[test]
+!test_report
  <- !fake_action(move(_));
     !fake_action(rotate(_));
     !fake_action(getCurrentPose(0.03, 0.04, 0));
     !fake_action(.stopMAS);
     +ready;
     !start;
     !assert_printed("50 mm from where I started").

@does_not_turn_when_it_cannot_drive[test]
+!test_stuck
  <- !fake_action(move(_), failed(blocked));
     +ready;
     !assert_fail(start);
     !assert_not_did(rotate(_)).
