// Tests of exploring and of going to a place; wheels and map are faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.
+!use_artifact(_, _, _).
+!use_artifact(_, _).

{ include("../robot.asl") }

+!fakes
  <- !fake_action(getRoute(_, _));
     !fake_action(getLeg(90, 0.5));
     !fake_action(rotate(_));
     !fake_action(moveForward(_)).

@ends_when_all_is_explored[test]
+!test_explored
  <- !fakes;
     !fake_action(getFrontier(_, _), failed(explored));
     !fake_action(getDistance(21.4));
     !explore;
     !assert_printed("explored, after driving 21 m");
     !assert_not_did(moveForward(_)).

@asks_for_help_when_something_else_is_wrong[test]
+!test_broken
  <- !fakes;
     !fake_action(updateSlamData(_, _, _));
     !fake_action(getFrontier(_, _), failed(no_map, "the laser is broken"));
     !fake_action(.stopMAS(_, _));
     +ready;
     !assert_fail(start);
     !assert_printed("I am stuck: the laser is broken");
     !assert_did(.stopMAS(0, 1)).

@turns_and_drives_as_the_map_says[test]
+!test_leg
  <- !fakes;
     !drive_a_leg;
     !assert_did(rotate(90));
     !assert_did(moveForward(0.5)).

@drives_until_it_is_at_the_place[test]
+!test_place
  <- !fakes;
     !fake_action(moveForward(_), after(1000));
     +pos2d(home, 0, 0);
     +pos2d(me, 5, 0);
     !!go_to(home);
     .wait(2500);
     -+pos2d(me, 0, 0);
     .wait(2000);
     !assert_printed("at the place called home");
     !assert_did(getRoute(0, 0), 3).
