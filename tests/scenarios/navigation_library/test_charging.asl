// Plans of $jacaros/navigation.asl for the battery; the robot is faked.

{ include("$jacaros/tester_agent.asl") }
{ include("$jacaros/navigation.asl") }

place(a, 1, 0, 0).
place(b, 2, 0, 0).

+!fakes
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !fake_action(dock, after(500));
     !fake_action(undock, after(500));
     !fake_action(dock_at(_), after(500));
     !fake_action(leave_dock, after(500));
     !fake_action(clear_costmaps).

@charges_in_the_middle_of_a_patrol_and_continues[test]
+!test_low
  <- !fakes;
     +battery(50, discharging);
     !!patrol([a, b]);
     !!keep_charged;
     .wait(1500);
     !assert_not_did(dock);
     -+battery(20, discharging);
     .wait(2500);
     -+battery(20, charging);
     .wait(10000);
     !assert_did(dock, 1);
     !assert_did(navigate_to(_, _, _), 2);
     !assert_not_did(undock);
     -+battery(94, charging);
     .wait(5000);
     !assert_not_did(undock);
     -+battery(95, charging);
     .wait(1200);
     !assert_did(undock, 1);
     .wait(300);
     !assert_did(navigate_to(1, 0, 0), 2);
     !assert_did(dock, 1);
     .drop_desire(patrol(_));
     .drop_desire(keep_charged).

@continues_when_no_reason_to_hold_is_left[test]
+!test_reasons
  <- !fakes;
     +battery(50);
     !!patrol([a, b]);
     !!keep_charged;
     .wait(100);
     -+battery(20);
     .wait(1000);
     !!hold(person);  // the robot is charging: it stands still for the person afterwards
     .wait(2000);
     !assert_did(navigate_to(_, _, _), 1);
     -+battery(100);
     .wait(2000);
     !assert_did(undock, 1);
     !assert_true(standing);
     !assert_did(navigate_to(_, _, _), 1);
     !release(person);
     .wait(1500);
     !assert_did(navigate_to(2, 0, 0), 1);
     .drop_desire(patrol(_));
     .drop_desire(keep_charged).

@charges_repeatedly[test]
+!test_again
  <- !fakes;
     !!keep_charged;
     +battery(10);
     .wait(1000);
     -+battery(100);
     .wait(1000);
     -+battery(15);
     .wait(1000);
     !assert_did(dock, 2);
     .drop_desire(keep_charged).

@the_program_sets_the_low_and_the_full_level[test]
+!test_levels
  <- !fakes;
     +low_at(40);
     +charged_at(60);
     +battery(39);
     !!keep_charged;
     .wait(1000);
     !assert_did(dock, 1);
     -+battery(60);
     .wait(1000);
     !assert_did(undock, 1);
     .drop_desire(keep_charged).

@accepts_a_driver_that_counts_in_percent[test]
+!test_percent
  <- +battery(9820, discharging);
     !assert_true(percent_left(98.2));
     !assert_false(battery_low);
     -+battery(1990, discharging);
     !assert_true(battery_low).

@drives_to_its_place_before_the_dock[test]
+!test_place
  <- !fakes;
     +place(dock, 4, 5, 180);
     +battery(100);
     !dock_and_charge;
     !assert_did(navigate_to(4, 5, 180), 1);
     !assert_did(dock, 1);
     !assert_did(undock, 1).

@nav2_docks_by_the_name_of_the_dock[test]
+!test_name
  <- !fakes;
     +dock_id("dock_2");
     +battery(100, full);
     !dock_and_charge;
     !assert_did(dock_at("dock_2"), 1);
     !assert_did(leave_dock, 1);
     !assert_not_did(dock).

@retries_docking[test]
+!test_retry
  <- !fakes;
     !fake_action(dock, failed(aborted(0, "not seen"), "the dock is not seen"));
     +battery(100);
     !!dock_and_charge;
     .wait(1000);
     !assert_not_did(undock);
     !fake_action(dock);
     .wait(3000);
     !assert_did(dock, 2);
     !assert_did(undock, 1).

@the_patrol_waits_while_the_robot_cannot_dock[test]
+!test_no_dock
  <- !fakes;
     !fake_action(dock, failed(aborted(0, "not seen"), "the dock is not seen"));
     +battery(10);
     !!patrol([a, b]);
     !!mind;
     .wait(trouble(_), 60000);
     !assert_true(trouble(aborted(0, "not seen")));
     !assert_did(dock, 3);
     .wait(5000);
     !assert_true(.intention(_, suspended));
     .drop_desire(patrol(_)).

+!mind
  <- !keep_charged.

-!mind[env_failure_reason(Reason)]
  <- +trouble(Reason).

// Percepts that say that no current flows end the wait within seconds; these do not wait for minutes.
@the_battery_says_that_it_discharges[test]
+!test_discharging
  <- +battery(30, discharging);
     !!hope;
     .wait(4000);
     !assert_false(hopeless(_));  // a message that was late
     .wait(1100);
     !assert_true(hopeless(no_current)).

@a_robot_that_leaves_its_dock_stops_waiting[test]
+!test_left
  <- +docked(true);
     +battery(30);
     !!hope;
     .wait(5000);
     -+docked(false);
     .wait(5100);
     !assert_true(hopeless(no_current)).

@a_level_that_falls_ends_the_wait[test]
+!test_falls
  <- +battery(30, charging);
     !!hope;
     .wait(1000);
     -+battery(29, charging);
     .wait(10000);
     !assert_false(hopeless(_));
     -+battery(20, charging);  // the gauge corrects itself
     .wait(10000);
     !assert_false(hopeless(_));
     -+battery(18, charging);
     .wait(100);
     !assert_true(hopeless(no_current)).

@a_contact_that_flickers_is_enough[test]
+!test_flickers
  <- +battery(94, charging);
     !!hope;
     for (.member(_, [1, 2, 3])) {
        -+battery(94, discharging);
        .wait(3000);
        -+battery(94, charging);
        .wait(3000)
     };
     -+battery(95, charging);
     .wait(100);
     !assert_false(hopeless(_));
     !assert_true(hopes).

@a_slow_battery_is_not_dead[test, timeout(3000000)]
+!test_slow
  <- +battery(93, charging);
     !!hope;
     .wait(200000);
     -+battery(94, charging);
     .wait(800000);
     -+battery(95, charging);
     .wait(100);
     !assert_false(hopeless(_));
     !assert_true(hopes).

@a_battery_that_charged_fast_is_abandoned_soon[test]
+!test_fast
  <- +battery(30, charging);
     !!hope;
     .wait(1000);
     -+battery(31, charging);
     .wait(13000);
     !assert_false(hopeless(_));
     .wait(1500);
     !assert_true(hopeless(no_current)).

+!hope
  <- !wait_until_charged;
     +hopes.

-!hope[env_failure_reason(Reason)]
  <- +hopeless(Reason).

@asks_a_person_when_it_cannot_charge[test, timeout(200000)]
+!test_help
  <- !fakes;
     !fake_action(dock, failed(aborted(0, "not seen"), "the dock is not seen"));
     !fake_action(ask(_, _, retry), after(60000));
     +battery(10, discharging);
     !!keep_charged;
     .wait(60000);
     !assert_did(dock, 3);
     !assert_true(held(battery));
     !fake_action(dock, after(500));
     .wait(8000);
     -+battery(100, full);
     .wait(2000);
     !assert_did(ask(_, _, _), 1);
     !assert_did(undock, 1);
     !assert_false(held(battery));
     .drop_desire(keep_charged).

@docks_anew_when_there_is_no_current[test]
+!test_anew
  <- !fakes;
     +battery(10, discharging);
     !!keep_charged;
     .wait(7000);
     !assert_did(dock, 2);
     !assert_did(undock, 1);
     -+battery(10, charging);
     .wait(10000);
     -+battery(100, full);
     .wait(1000);
     !assert_did(dock, 2);
     !assert_did(undock, 2);
     .drop_desire(keep_charged).

@leaves_a_dock_without_current_before_it_docks[test]
+!test_in_dead_dock
  <- !fakes;
     +docked(true);
     +battery(10, discharging);
     !!keep_charged;
     .wait(400);
     !assert_did(undock, 1);
     !assert_not_did(dock);
     .wait(400);
     !assert_did(dock, 1);
     .drop_desire(keep_charged).

@stays_in_a_dock_with_current[test]
+!test_in_dock
  <- !fakes;
     +docked(true);
     +battery(10, charging);
     !!keep_charged;
     .wait(2000);
     -+battery(100, full);
     .wait(1000);
     !assert_not_did(dock);
     !assert_did(undock, 1);
     .drop_desire(keep_charged).

@does_not_leave_a_dock_that_it_is_not_in[test]
+!test_false_dock
  <- !fakes;
     +docked(false);
     +battery(10, discharging);
     !!mind;
     .wait(trouble(no_current), 30000);
     !assert_did(dock, 3);
     !assert_not_did(undock).

@does_not_try_again_with_an_empty_battery[test]
+!test_empty_battery
  <- !fakes;
     +docked(false);
     +battery(0, discharging);
     !!mind;
     .wait(trouble(no_current), 30000);
     !assert_did(dock, 1).
