// Plans of $jacaros/navigation.asl for patrols; the robot is faked.

{ include("$jacaros/tester_agent.asl") }

+!arrived(Place)
  <- +been(Place).

{ include("$jacaros/navigation.asl") }

place(a, 1, 0, 0).
place(b, 2, 0, 0).
place(c, 3, 0, 0).

+!fakes
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !fake_action(clear_costmaps).

@repeats_its_rounds[test]
+!test_round
  <- !fakes;
     !!patrol([a, b]);
     .wait(4500);
     !assert_did(navigate_to(1, 0, 0), 3);
     !assert_did(navigate_to(2, 0, 0), 2);
     .drop_desire(patrol(_));
     .wait(3000);
     !assert_did(navigate_to(_, _, _), 5).

@stops_after_the_given_number_of_rounds[test]
+!test_rounds
  <- !fakes;
     !patrol([a, b, c], 2);
     !assert_did(navigate_to(_, _, _), 6).

@stops_while_suspended_and_continues_where_it_was[test]
+!test_suspended
  <- !fakes;
     !!patrol([a, b, c]);
     .wait(1500);
     .suspend(patrol(_));
     .wait(10000);
     !assert_not_did(navigate_to(3, 0, 0));
     .resume(patrol(_));
     .wait(been(c), 3000);
     .drop_desire(patrol(_)).

@skips_a_place_that_it_cannot_reach[test]
+!test_unreachable
  <- +attempts(1);
     !fakes;
     !fake_action(navigate_to(2, 0, 0), failed(aborted(208, "no way"), "no way"));
     !assert_fail(patrol([a, b, c], 1));
     !assert_true(unreachable(b, aborted(208, _)));
     !assert_true(been(a) & been(c) & not been(b));
     !assert_did(navigate_to(2, 0, 0), 2);  // it has come back
     !fakes;
     !patrol([b], 1);
     !assert_false(unreachable(b, _)).

@comes_back_to_a_place_in_the_same_round[test]
+!test_come_back
  <- +attempts(1);
     !fakes;
     !fake_action(navigate_to(2, 0, 0), failed(aborted(208, "no way"), "no way"));
     !!patrol([a, b, c], 1);
     .wait(been(a), 3000);
     .wait(unreachable(b, _), 3000);
     !fake_action(navigate_to(2, 0, 0), after(1000));
     .wait(been(b), 5000);
     !assert_true(been(c)).

@a_place_that_was_left_out_in_one_round_fails_the_patrol_at_its_end[test]
+!test_left_out
  <- +attempts(1);
     !fakes;
     !fake_action(navigate_to(2, 0, 0), failed(aborted(208, "no way"), "no way"));
     !assert_fail(patrol([a, b], 3))
     |&|
     (.wait(left_out(b, _), 10000); !fake_action(navigate_to(2, 0, 0), after(1000)));
     !assert_true(been(b)).

@an_unknown_place_ends_the_patrol[test]
+!test_unknown
  <- !fakes;
     !assert_fail(patrol([a, nowhere]));
     !assert_true(been(a)).

@has_nothing_to_do_without_places[test]
+!test_empty
  <- !patrol([]);
     !assert_not_did(navigate_to(_, _, _)).

@goes_again_to_a_place_that_it_has_missed[test]
+!test_missed
  <- +arrives_within(0.05);
     +pose(1.1, 0, 0);
     !fake_action(navigate_to(_, _, _), after(1000));
     !!patrol([a], 1);
     .wait(2500);
     !assert_false(been(a));
     -+pose(1.04, 0, 0);
     .wait(been(a), 5000);
     !assert_did(navigate_to(1, 0, 0), 2).

@says_that_it_stands_beside_a_place[test]
+!test_beside
  <- +arrives_within(0.05);
     +pose(1.1, 0, 0);
     !fakes;
     !round([a]);
     !assert_true(unreachable(a, not_there));
     !assert_false(been(a));
     !assert_did(navigate_to(1, 0, 0), 3).

// The drive to the dock begins where the place has been visited.
@visits_a_place_that_it_has_nearly_reached_before_it_charges[test]
+!test_nearly
  <- +visits_within(0.1);
     +place(dock, 9, 9, 0);
     !fakes;
     !fake_action(navigate_to(_, _, _), after(2000));
     !fake_action(dock, after(1000));
     !fake_action(undock);
     +pose(0, 0, 0);
     !!patrol([a, b], 1);
     .wait(500);
     -+pose(0.85, 0, 0);
     +battery(100);
     !!charge_first;
     .wait(500);
     !assert_not_did(navigate_to(9, 9, 0));
     -+pose(0.95, 0, 0);
     .wait(been(a), 500);
     .wait(been(b), 20000);
     !assert_did(dock, 1);
     !assert_did(navigate_to(1, 0, 0), 1).
