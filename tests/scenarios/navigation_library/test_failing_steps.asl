// A program's own steps that fail: every kind of failure reaches the right goal.

{ include("$jacaros/tester_agent.asl") }

+!drive_there(1, _, _)
  <- ?map_of(cellar).  // fails without a reason from an operation

+!recover(test_goal_failed) : broken_recovery
  <- ?spare_wheel.

+!recover(Reason) : own_recovery
  <- +recovered(Reason).

+!forget_obstacles : own_recovery
  <- ?vacuum_cleaner.

+!drive_into_dock : own_dock
  <- ?dock_in_sight.

+!drive_out_of_dock : own_dock_out
  <- .fail(error(stuck), error_msg("the wheels turn, the robot does not")).

+!wait_until_charged : own_charging
  <- ?charger.

+!arrived(Place) : own_arrival(ia)
  <- ?camera(Place).

+!arrived(Place) : own_arrival(action)
  <- take_picture.

+!visit(Place) : own_visit
  <- !go_to(Place);
     take_picture.

+!dock_and_charge : own_charging(all)
  <- ?solar_panel.

{ include("$jacaros/navigation.asl") }

place(a, 1, 0, 0).
place(b, 2, 0, 0).

+!fakes
  <- !fake_action(navigate_to(_, _, _));
     !fake_action(clear_costmaps);
     !fake_action(dock);
     !fake_action(undock);
     !fake_action(take_picture, failed(service_timeout(3), "the camera does not answer")).

// Record how a goal of the program fails.
+!hear(Goal)
  <- !Goal;
     +heard(nothing, nothing).

-!hear(_)[error(Error), env_failure_reason(Reason)]
  <- +heard(Error, Reason).

-!hear(_)[error(Error)]
  <- +heard(Error, none).

@retries_a_drive_that_fails_without_a_reason_and_then_fails[test]
+!test_drive
  <- +own_recovery;
     !!hear(go_to(a));
     .wait(heard(test_goal_failed, none), 60000);
     !assert_true(recovered(test_goal_failed)).

@ignores_failures_while_forgetting_obstacles[test]
+!test_forget
  <- !fakes;
     +own_recovery;
     !fake_action(navigate_to(_, _, _), failed(aborted(105, "stuck"), "stuck"));
     !!hear(go_to(b));
     .wait(heard(action_failed, aborted(105, "stuck")), 60000);
     !assert_did(navigate_to(_, _, _), 3).

@a_recovery_that_fails_ends_the_attempts[test]
+!test_recovery
  <- +broken_recovery;
     !!hear(go_to(a));
     .wait(heard(test_goal_failed, none), 1000).

@a_patrol_skips_an_unreachable_place_for_any_reason[test]
+!test_unreachable
  <- !fakes;
     +attempts(1);
     !!hear(patrol([a, b], 1));
     .wait(heard(left_out, test_goal_failed), 60000);
     !assert_true(unreachable(a, test_goal_failed));
     !assert_false(unreachable(b, _)).

@a_place_that_was_reached_is_not_unreachable[test]
+!test_arrived
  <- !fakes;
     +own_arrival(action);
     !!hear(patrol([b], 2));
     .wait(heard(action_failed, service_timeout(3)), 60000);
     !assert_false(unreachable(_, _));
     !assert_did(navigate_to(_, _, _), 1).

@the_action_at_a_place_may_fail_without_a_reason[test]
+!test_arrived_plain
  <- !fakes;
     +own_arrival(ia);
     !!hear(patrol([b]));
     .wait(heard(test_goal_failed, none), 60000);
     !assert_false(unreachable(_, _)).

@a_failing_visit_of_the_program_fails_the_patrol[test]
+!test_visit
  <- !fakes;
     +own_visit;
     !!hear(patrol([b]));
     .wait(heard(action_failed, service_timeout(3)), 60000);
     !assert_false(unreachable(_, _)).

@retries_docking_of_the_program_and_then_fails[test]
+!test_dock
  <- !fakes;
     +own_dock;
     +own_recovery;
     !!hear(dock_and_charge);
     .wait(heard(test_goal_failed, none), 60000);
     !assert_true(recovered(test_goal_failed)).

@retries_leaving_the_dock_of_the_program_and_then_fails[test]
+!test_undock
  <- !fakes;
     +own_dock_out;
     +own_recovery;
     +battery(100);
     !!hear(dock_and_charge);
     .wait(heard(stuck, none), 60000);
     !assert_true(recovered(stuck)).

@waiting_of_the_program_may_fail[test]
+!test_charging
  <- !fakes;
     +own_charging;
     !!hear(dock_and_charge);
     .wait(heard(test_goal_failed, none), 60000).

@failing_charging_of_the_program_fails_keep_charged[test]
+!test_all
  <- !fakes;
     +own_charging(all);
     +battery(10);
     !!hear(keep_charged);
     .wait(heard(test_goal_failed, none), 60000).
