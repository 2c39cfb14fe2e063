// Tests of robot.asl with a faked robot: run them with `jacaros test`.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.  // before the include: the robot does not drive until a test is ready

{ include("../robot.asl") }

speed(0.2).
pose(0.6, 0, 0).

@drives_ahead_and_back[test]
+!test_trips
  <- !fake_action(drive(_, _, _));
     !fake_action(.stopMAS);
     +ready;
     !start;
     !assert_did(drive(0.2, 0, 3), 2);
     !assert_did(drive(-0.2, 0, 3), 2);
     !assert_printed("ahead, at 0.6 m").

@asks_for_help_when_it_cannot_drive[test]
+!test_stuck
  <- !fake_action(drive(_, _, _), failed(stuck, "a wheel does not turn"));
     !fake_action(.stopMAS(_, _));
     +ready;
     !start;
     !assert_printed("I need help: a wheel does not turn");
     !assert_did(.stopMAS(0, 1)).
