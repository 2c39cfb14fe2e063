// Tests of charging, and of who watches in the meantime; the robot and its colleagues are faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.

{ include("../robot.asl") }

dock_id("dock_1").
watched(north_west).

+!fakes
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !fake_action(dock_at(_), after(1000));
     !fake_action(leave_dock, after(1000)).

@visits_its_own_places_and_those_of_others[test]
+!test_watch
  <- !fakes;
     !!watch;
     .wait(1500);
     +watched(south_east)[source(robot_2)];
     .wait(3000);
     !assert_did(navigate_to(3.2, -2.2, 180));
     !assert_printed("at south_east for robot_2");
     .abolish(watched(south_east));
     .drop_desire(watch).

@charges_in_its_dock_when_the_battery_is_low[test]
+!test_low
  <- !fakes;
     +battery(20, discharging);
     !!keep_charged;
     !!watch;
     .wait(3000);
     !assert_did(dock_at("dock_1"), 1);
     !assert_true(charging);
     -+battery(20, charging);
     !assert_printed("no robot has time for my places");
     -+battery(96, charging);
     .wait(2000);
     !assert_did(leave_dock, 1);
     !assert_false(charging);
     !assert_true(recharges(1));
     .drop_desire(keep_charged);
     .drop_desire(watch).

@gives_its_places_to_the_fullest_colleague[test]
+!test_choose
  <- .my_name(Me);  // the fullest one is this agent itself, because the test has no other
     !choose([offer(60, one), offer(90, Me), offer(50, three)]);
     !assert_true(helper(Me));
     !assert_printed("has my places").

@offers_help_only_with_a_good_battery_and_not_in_the_dock[test]
+!test_help
  <- +battery(41, discharging);
     !assert_true(can_help(41));
     -+battery(40, discharging);
     !assert_false(can_help(_));
     -+battery(90, charging);
     +charging;
     !assert_false(can_help(_)).

@ends_its_shift_in_the_dock[test]
+!test_shift
  <- !fakes;
     !fake_action(.stopMAS(_, _));
     !!watch;
     -+recharges(2);
     !end_of_shift;
     !assert_did(.stopMAS, 1);
     !assert_false(.desire(watch));
     !assert_printed("my shift is over").

@a_robot_in_need_leaves_its_places_to_the_others[test]
+!test_need
  <- !fakes;
     !fake_action(dock_at(_), failed(not_charging, "the contacts are dirty"));
     !fake_action(.stopMAS(_, _));
     +battery(20, discharging);
     !!watch;
     !!keep_charged;
     .wait(30000);
     !assert_printed("I am stuck: not_charging");
     !assert_printed("I need help: the contacts are dirty");
     !assert_false(.desire(watch));
     !assert_did(.stopMAS(0, 1), 1).
