// Steps that a program does in its own way, and that fail: the failures arrive where they belong, whatever their kind.

{ include("$jacaros/tester_agent.asl") }

+!drive_there(1, _, _)
  <- ?map_of(cellar).  // fails with no reason of an operation

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

// What a program hears of a goal that fails.
+!hear(Goal)
  <- !Goal;
     +heard(nothing, nothing).

-!hear(_)[error(Error), env_failure_reason(Reason)]
  <- +heard(Error, Reason).

-!hear(_)[error(Error)]
  <- +heard(Error, none).

@a_drive_that_fails_without_a_reason_is_tried_again_and_then_told[test]
+!test_drive
  <- +own_recovery;
     !!hear(go_to(a));
     .wait(heard(test_goal_failed, none), 60000);
     !assert_true(recovered(test_goal_failed)).

@what_fails_while_obstacles_are_forgotten_does_not_matter[test]
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

@a_patrol_leaves_out_what_it_cannot_reach_whatever_the_reason[test]
+!test_unreachable
  <- !fakes;
     +attempts(1);
     !!hear(patrol([a, b], 1));
     .wait(heard(nothing, nothing), 60000);
     !assert_true(unreachable(a, test_goal_failed));
     !assert_false(unreachable(b, _)).

@a_place_that_was_reached_is_not_called_unreachable[test]
+!test_arrived
  <- !fakes;
     +own_arrival(action);
     !!hear(patrol([b], 2));
     .wait(heard(action_failed, service_timeout(3)), 60000);
     !assert_false(unreachable(_, _));
     !assert_did(navigate_to(_, _, _), 1).

@what_is_done_at_a_place_may_fail_without_a_reason[test]
+!test_arrived_plain
  <- !fakes;
     +own_arrival(ia);
     !!hear(patrol([b]));
     .wait(heard(test_goal_failed, none), 60000);
     !assert_false(unreachable(_, _)).

@a_visit_of_its_own_fails_the_patrol[test]
+!test_visit
  <- !fakes;
     +own_visit;
     !!hear(patrol([b]));
     .wait(heard(action_failed, service_timeout(3)), 60000);
     !assert_false(unreachable(_, _)).

@a_dock_of_its_own_is_tried_again_and_then_told[test]
+!test_dock
  <- !fakes;
     +own_dock;
     +own_recovery;
     !!hear(dock_and_charge);
     .wait(heard(test_goal_failed, none), 60000);
     !assert_true(recovered(test_goal_failed)).

@the_way_out_of_its_own_dock_too[test]
+!test_undock
  <- !fakes;
     +own_dock_out;
     +own_recovery;
     +battery(100);
     !!hear(dock_and_charge);
     .wait(heard(stuck, none), 60000);
     !assert_true(recovered(stuck)).

@waiting_in_its_own_way_may_fail[test]
+!test_charging
  <- !fakes;
     +own_charging;
     !!hear(dock_and_charge);
     .wait(heard(test_goal_failed, none), 60000).

@charging_in_its_own_way_fails_keep_charged[test]
+!test_all
  <- !fakes;
     +own_charging(all);
     +battery(10);
     !!hear(keep_charged);
     .wait(heard(test_goal_failed, none), 60000).
