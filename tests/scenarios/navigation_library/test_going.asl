// Plans of $jacaros/navigation.asl that go to a place; the robot is faked.

{ include("$jacaros/tester_agent.asl") }
{ include("$jacaros/navigation.asl") }

place(kitchen, 2, 3, 90).

@goes_to_a_place_by_its_name[test]
+!test_place
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !go_to(kitchen);
     !assert_did(navigate_to(2, 3, 90), 1).

@fails_for_an_unknown_place[test]
+!test_unknown
  <- !fake_action(navigate_to(_, _, _));
     !!ask(cellar);
     .wait(reason(_), 1000);
     !assert_true(reason(unknown_place(cellar)));
     !assert_not_did(navigate_to(_, _, _)).

@retries_when_no_path_was_found[test]
+!test_blocked
  <- !fake_action(navigate_to(_, _, _), failed(aborted(208, "no way"), "no way"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(1000);
     !fake_action(navigate_to(_, _, _));
     .wait(arrived, 5000);
     !assert_did(navigate_to(2, 3, 90), 2);
     !assert_did(clear_costmaps, 1).

@fails_with_the_reason_after_all_attempts[test]
+!test_attempts
  <- +attempts(4);
     !fake_action(navigate_to(_, _, _), failed(timeout(60), "too late"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(reason(_), 60000);
     !assert_true(reason(timeout(60)));
     !assert_true(text("too late"));
     !assert_did(navigate_to(2, 3, 90), 4).

@makes_three_attempts_by_default[test]
+!test_three
  <- !fake_action(navigate_to(_, _, _), failed(rejected, "not now"));
     !!ask(kitchen);
     .wait(reason(rejected), 60000);
     !assert_did(navigate_to(2, 3, 90), 3).

@does_not_retry_a_cancelled_goal[test]
+!test_canceled
  <- !fake_action(navigate_to(_, _, _), failed(canceled, "cancelled"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(reason(_), 60000);
     !assert_true(reason(canceled));
     !assert_did(navigate_to(_, _, _), 1);
     !assert_not_did(clear_costmaps).

@waits_for_a_server_that_has_stopped[test]
+!test_server
  <- !fake_action(navigate_to(_, _, _), failed(server_lost, "gone"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(2900);
     !assert_did(navigate_to(_, _, _), 1);
     !fake_action(navigate_to(_, _, _));
     .wait(arrived, 5000);
     !assert_not_did(clear_costmaps).

@retries_on_a_robot_that_cannot_forget_obstacles[test]
+!test_forget
  <- !fake_action(navigate_to(_, _, _), failed(aborted(105, "stuck"), "stuck"));
     !fake_action(clear_costmaps, failed(service_unavailable("x"), "no such service"));
     !!ask(kitchen);
     .wait(reason(aborted(105, "stuck")), 60000);
     !assert_did(navigate_to(_, _, _), 3).

+!ask(Place)
  <- !go_to(Place);
     +arrived.

-!ask(_)[error_msg(Text), env_failure_reason(Reason)]
  <- +text(Text);
     +reason(Reason).
