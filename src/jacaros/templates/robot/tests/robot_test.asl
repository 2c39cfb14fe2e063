// Tests of robot.asl with faked wheels: run them with `jacaros test`.

{ include("$jacaros/tester_agent.asl") }

+!start.  // before the include: the robot's own plan for this goal would use the wheels

{ include("../robot.asl") }

@visits_a_place[test]
+!test_visit
  <- !fake_action(driveTo(_, _));
     !visit(window);
     !assert_did(driveTo(3.2, 2.2));
     !assert_printed("at the window").

@continues_when_the_way_is_blocked[test]
+!test_blocked
  <- !fake_action(driveTo(_, _), failed(blocked, "a box is in the way"));
     !visit(table);
     !assert_printed("cannot reach the table: a box is in the way").

@charges_when_the_battery_is_low[test]
+!test_low_battery
  <- !fake_action(driveTo(_, _));
     !fake_action(operationRecharge);
     ++diagnostics("Low Battery");
     .wait(100);
     !assert_did(driveTo(0.6, 0.6));
     !assert_did(operationRecharge);
     !assert_printed("battery full").
