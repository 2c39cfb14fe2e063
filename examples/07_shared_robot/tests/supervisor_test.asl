// Tests of the supervisor; the shift, the wheels and the battery are faked.

{ include("$jacaros/tester_agent.asl") }

{ include("../supervisor.asl") }

+!fakes
  <- !fake_action(take_over, after(500));
     !fake_action(hand_over);
     !fake_action(driveTo(_, _), after(1000));
     !fake_action(operationRecharge, after(2000));
     !fake_action(.stopMAS).

@takes_the_robot_when_the_battery_is_low_and_gives_it_back_full[test]
+!test_low
  <- !fakes;
     +battery(19);
     +diagnostics("Low Battery");
     .wait(recharges(1), 10000);
     !assert_did(driveTo(1, 1), 1);
     !assert_did(operationRecharge, 1);
     !assert_did(hand_over, 1);
     !assert_printed("I want the robot: 19 % left").

@does_not_drive_without_having_the_robot[test]
+!test_without
  <- !fakes;
     !fake_action(take_over, failed(interrupted, "the shift is gone"));
     +battery(19);
     +diagnostics("Low Battery");
     !assert_did(take_over, 1);
     !assert_not_did(driveTo(_, _));
     !assert_printed("I need help: the shift is gone").

@leaves_the_driver_alone_while_there_is_power[test]
+!test_medium
  <- !fakes;
     +battery(50);
     +diagnostics("Medium Battery");
     !assert_not_did(take_over).

@ends_the_shift_at_home_after_its_rounds[test]
+!test_end
  <- !fakes;
     +visits(15);
     .wait(100);
     !assert_not_did(take_over);
     -+visits(16);
     .wait(3000);
     !assert_did(take_over, 1);
     !assert_did(driveTo(0, 0), 1);
     !assert_printed("the robot is at home: 4 rounds, 0 recharges");
     !assert_did(.stopMAS).

@asks_for_help_when_it_misses_the_dock[test]
+!test_missed
  <- !fakes;
     !fake_action(driveTo(1, 1), failed(blocked, "something stands in my way"));
     +battery(19);
     +diagnostics("Low Battery");
     !assert_printed("I need help: something stands in my way");
     !assert_did(.stopMAS(0, 1));
     !assert_not_did(hand_over).
