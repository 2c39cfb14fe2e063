// Plans of $jacaros/navigation.asl that go somewhere; the robot is faked.

{ include("$jacaros/tester_agent.asl") }
{ include("$jacaros/navigation.asl") }

place(kitchen, 2, 3, 90).

@goes_to_a_place_by_its_name[test]
+!test_place
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !go_to(kitchen);
     !assert_did(navigate_to(2, 3, 90), 1).

@a_place_that_nobody_knows_is_told[test]
+!test_unknown
  <- !fake_action(navigate_to(_, _, _));
     !!ask(cellar);
     .wait(reason(_), 1000);
     !assert_true(reason(unknown_place(cellar)));
     !assert_not_did(navigate_to(_, _, _)).

@tries_again_when_there_was_no_way[test]
+!test_blocked
  <- !fake_action(navigate_to(_, _, _), failed(aborted(208, "no way"), "no way"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(1000);
     !fake_action(navigate_to(_, _, _));
     .wait(arrived, 5000);
     !assert_did(navigate_to(2, 3, 90), 2);
     !assert_did(clear_costmaps, 1).

@gives_up_after_its_attempts_with_the_reason[test]
+!test_attempts
  <- +attempts(4);
     !fake_action(navigate_to(_, _, _), failed(timeout(60), "too late"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(reason(_), 60000);
     !assert_true(reason(timeout(60)));
     !assert_true(text("too late"));
     !assert_did(navigate_to(2, 3, 90), 4).

@three_attempts_unless_the_program_says_otherwise[test]
+!test_three
  <- !fake_action(navigate_to(_, _, _), failed(rejected, "not now"));
     !!ask(kitchen);
     .wait(reason(rejected), 60000);
     !assert_did(navigate_to(2, 3, 90), 3).

@does_not_try_again_what_was_cancelled[test]
+!test_canceled
  <- !fake_action(navigate_to(_, _, _), failed(canceled, "cancelled"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(reason(_), 60000);
     !assert_true(reason(canceled));
     !assert_did(navigate_to(_, _, _), 1);
     !assert_not_did(clear_costmaps).

@waits_for_a_server_that_is_gone[test]
+!test_server
  <- !fake_action(navigate_to(_, _, _), failed(server_lost, "gone"));
     !fake_action(clear_costmaps);
     !!ask(kitchen);
     .wait(2900);
     !assert_did(navigate_to(_, _, _), 1);
     !fake_action(navigate_to(_, _, _));
     .wait(arrived, 5000);
     !assert_not_did(clear_costmaps).

@a_robot_that_cannot_forget_obstacles_tries_all_the_same[test]
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
