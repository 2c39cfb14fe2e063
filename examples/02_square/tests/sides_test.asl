// Tests of robot.asl without a robot: its actions are faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.
+!use_artifact(_, _).
+!use_artifact(_, _, _).

{ include("../robot.asl") }

+!fakes(Ahead)
  <- !fake_action(moveForward(_), after(1000));
     !fake_action(rotate(_));
     !fake_action(getCurrentPose(Ahead, 0.01, 0));
     !fake_action(.stopMAS);
     !fake_action(.stopMAS(_, _));
     +ready.

@has_four_sides[test]
+!test_sides
  <- !fakes(0);
     !start;
     !assert_did(moveForward(1), 4);
     !assert_did(rotate(90), 4);
     !assert_printed("side 4 done");
     !assert_did(.stopMAS).

@tells_where_it_is_and_that_it_is_not_back[test]
+!test_places
  <- !fakes(0.5);
     !start;
     !assert_printed("side 1 done, at 50 cm, 1 cm");
     !assert_printed("I am not back at the start, I need help");
     !assert_not_did(.stopMAS);
     !assert_did(.stopMAS(0, 1)).

@does_not_go_on_when_somebody_has_lifted_it[test]
+!test_lifted
  <- !fakes(0);
     !!start;
     .wait(500);
     ++hazard(wheel_drop, "wheel_drop_left");
     .wait(100);
     !assert_printed("I need help");
     !assert_did(.stopMAS(0, 1)).

@does_not_go_on_when_it_has_touched_something[test]
+!test_touched
  <- !fakes(0);
     !!start;
     .wait(500);
     ++hazard(bump, "bump_front_left");
     .wait(100);
     !assert_printed("I need help");
     !assert_did(.stopMAS(0, 1)).
