// Plans of $jacaros/navigation.asl for a robot that is lost; the robot is faked.

{ include("$jacaros/tester_agent.asl") }

+!arrived(_)
  <- .wait(3000);
     +done.

{ include("$jacaros/navigation.asl") }

place(kitchen, 2, 3, 90).

// Not in the intention of the test.
+!sense_lost <- +lost.
-!sense_lost[env_failure_reason(Reason)] <- +gave_up(Reason).
+!sense_found <- -lost.

+!fake_robot
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !fake_action(relocalise);
     !fake_action(spin(_), after(1000));
     !fake_action(drive_on_heading(_, _), after(1000)).

@searches_until_it_is_found_and_returns_to_its_work[test]
+!test_found
  <- !fake_robot;
     !!visit(kitchen);
     .wait(.desire(arrived(kitchen)), 5000);
     !!sense_lost;
     .wait(2500);
     !!sense_found;
     .wait(done, 20000);
     !assert_did(relocalise, 1);
     !assert_did(spin(360), 2);
     !assert_did(navigate_to(2, 3, 90), 2).

@gives_up_standing_until_a_person_shows_it_the_place[test]
+!test_given_up
  <- !fake_robot;
     !!sense_lost;
     .wait(held(lost), 20000);
     !assert_did(spin(360), 4);
     .wait(standing, 1000);
     !assert_true(gave_up(lost));
     !!sense_found;
     .wait(not standing, 1000);
     !assert_did(relocalise, 1).

@searches_without_a_service_and_by_other_wheels[test]
+!test_other_robot
  <- !fake_action(drive(_, _, _), after(1000));
     !!sense_lost;
     .wait(500);
     !!sense_found;
     .wait(2000);
     !assert_did(drive(0, 45, 8), 1).

@a_robot_whose_wheels_drop_stands_until_it_knows_where_it_is[test]
+!test_lifted
  <- !fake_action(navigate_to(_, _, _), after(1000));
     +place(far, 9, 9, 0);
     !!go_to(far);
     .wait(500);
     ++hazard(wheel_drop, "wheel_drop_left");
     ++hazard(wheel_drop, "wheel_drop_right");
     .wait(100);
     !assert_true(lifted);
     .wait(3100);
     !assert_false(lifted).

@a_robot_that_is_lifted_at_a_place_has_visited_it[test]
+!test_lifted_there
  <- +visits_within(0.1);
     +pose(2.05, 3, 90);
     !fake_action(navigate_to(_, _, _), after(5000));
     !!patrol([kitchen], 1);
     .wait(500);
     -+pose(2.04, 3, 90);
     .wait(200);
     !assert_false(done);
     ++hazard(wheel_drop, "wheel_drop_left");
     .wait(done, 8000);
     .wait(3000);
     !assert_did(navigate_to(_, _, _), 1).
