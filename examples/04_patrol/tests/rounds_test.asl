// Tests of the patrol: the order of the corners, and the end of the shift.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.

{ include("../robot.asl") }

@goes_round_the_corners[test]
+!test_corners
  <- !fake_action(driveTo(_, _), after(1000));
     !!patrol([1, 2, 3, 4]);
     .wait(visits(5), 10000);
     !assert_did(driveTo(2, 0), 2);
     !assert_did(driveTo(2, 2));
     !assert_did(driveTo(0, 2));
     !assert_did(driveTo(0, 0));
     !assert_printed("round 1, corner 4");
     !assert_printed("round 2, corner 1").

@ends_the_shift_after_its_recharges[test]
+!test_shift
  <- !fake_action(.stopMAS(_, _));
     -+recharges(10);
     -+visits(42);
     !arrived(3);
     !assert_not_did(driveTo(_, _));
     !assert_printed("43 corners, that is 10 rounds and 3 of the next");
     !assert_printed("10 recharges, and never less than 100 %");
     !assert_did(.stopMAS).

@tells_by_the_exit_status_that_a_corner_was_left_out[test]
+!test_left_out
  <- !fake_action(.stopMAS(_, _));
     -+recharges(10);
     +unreachable(2, blocked(0.3));
     !arrived(3);
     !assert_did(.stopMAS(0, 1)).

@remembers_the_lowest_percentage_only[test]
+!test_lowest
  <- !remember(30);
     !remember(17);
     !remember(25);
     .findall(Least, lowest(Least), All);
     !assert_true(All == [17]).
