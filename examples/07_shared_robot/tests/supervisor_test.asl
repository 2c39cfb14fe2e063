// Tests of the supervisor; the shift, the wheels and the battery are faked.

{ include("$jacaros/tester_agent.asl") }

{ include("../supervisor.asl") }

+!fakes
  <- !fake_action(take_over, after(500));
     !fake_action(hand_over);
     !fake_action(driveTo(_, _), after(1000));
     !fake_action(operationRecharge, after(2000));
     !fake_action(.stopMAS);
     !fake_action(.stopMAS(_, _)).

-!low.

+!low
  <- +battery(19);
     +diagnostics("Low Battery").

@takes_the_robot_when_the_battery_is_low_and_gives_it_back_full[test]
+!test_low
  <- !fakes;
     !!low;
     .wait(recharges(1), 10000);
     !assert_did(driveTo(1, 1), 1);
     !assert_did(operationRecharge, 1);
     !assert_did(hand_over, 1);
     !assert_printed("I want the robot: 19 % left").

@does_not_drive_without_having_the_robot[test, timeout(120000)]
+!test_without
  <- !fakes;
     !fake_action(take_over, failed(interrupted, "the shift is gone"));
     !!low;
     .wait(70000);
     !assert_printed("I am stuck: the shift is gone");
     !assert_did(take_over, 7);
     !assert_not_did(driveTo(_, _)).

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

@goes_on_when_the_way_is_free_again[test]
+!test_free_again
  <- !fakes;
     !fake_action(driveTo(1, 1), failed(blocked, "something stands in my way"));
     !!low;
     .wait(20000);
     !fake_action(driveTo(1, 1));
     .wait(recharges(1), 30000);
     !assert_did(hand_over, 1).

@goes_on_when_a_person_has_helped[test, timeout(120000)]
+!test_helped
  <- !fakes;
     !fake_action(driveTo(1, 1), failed(blocked, "something stands in my way"));
     !fake_action(ask(_, _, retry), after(1000));
     !!low;
     .wait(64500);
     !fake_action(driveTo(1, 1));
     .wait(recharges(1), 30000);
     !assert_did(hand_over, 1);
     !assert_not_did(.stopMAS(_, _)).

@tells_and_ends_the_run_when_it_misses_the_dock_without_help[test, timeout(120000)]
+!test_missed
  <- !fakes;
     !fake_action(driveTo(1, 1), failed(blocked, "something stands in my way"));
     !!low;
     .wait(70000);
     !assert_printed("I am stuck: something stands in my way");
     !assert_did(.stopMAS(0, 1));
     !assert_not_did(hand_over).
