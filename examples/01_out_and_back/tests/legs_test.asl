// Tests of robot.asl without a robot: its actions are faked.  Run them with `jacaros test legs_test.asl`.

{ include("$jacaros/tester_agent.asl") }

// Plans before an include override the plans of the included file.
+!start : not ready.   // the initial goal of robot.asl does nothing until a test is ready
+!use_artifact(_, _).  // no wheels
+!use_artifact(_, _, _).

{ include("../robot.asl") }

+!fakes(Ahead)
  <- !fake_action(move(_));
     !fake_action(rotate(_));
     !fake_action(moveForward(_), after(1000));
     !fake_action(getCurrentPose(Ahead, 0.04, 0));  // the pose that the fake returns
     !fake_action(.stopMAS);
     !fake_action(.stopMAS(_, _));
     +ready.

// A plan with `test` in its label is a test.
@drives_out_and_back[test]
+!test_legs
  <- !fakes(0.02);
     !start;
     !assert_did(move(25), 2);
     !assert_did(rotate(180), 2);
     !assert_printed("driving out");
     !assert_printed("driving back");
     !assert_printed("45 mm from where I started");
     !assert_did(.stopMAS).

@drives_what_is_missing[test]
+!test_rest
  <- !fakes(0.02);
     !start;
     !assert_did(moveForward(-0.02), 1).

@says_that_it_is_not_back[test]
+!test_report
  <- !fakes(0.6);
     !start;
     !assert_printed("601 mm from where I started");
     !assert_printed("I am not where I started, I need help");
     !assert_not_did(.stopMAS);
     !assert_did(.stopMAS(0, 1)).

@does_not_go_on_when_somebody_has_lifted_it[test]
+!test_lifted
  <- !fakes(0.02);
     !!start;
     .wait(500);
     ++hazard(wheel_drop, "wheel_drop_left");
     .wait(100);
     !assert_printed("I need help");
     !assert_did(.stopMAS(0, 1)).

@does_not_go_on_when_it_has_touched_something[test]
+!test_touched
  <- !fakes(0.02);
     !!start;
     .wait(500);
     ++hazard(bump, "bump_front_left");
     .wait(100);
     !assert_printed("I need help");
     !assert_did(.stopMAS(0, 1)).

@does_not_turn_when_it_cannot_drive[test]
+!test_stuck
  <- !fakes(0.02);
     !fake_action(move(_), failed(blocked));
     !start;
     !assert_printed("I need help");
     !assert_not_did(rotate(_)).
