// Tests of an errand and of its crossings; the robot is faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.

{ include("../robot.asl") }

brings(linen).
lane(1.5).
handling(1000).

+!fakes
  <- !fake_action(navigate_to(_, _, _), after(1000));
     !fake_action(.stopMAS).

@brings_one_load_and_comes_back[test]
+!test_errand
  <- !fakes;
     +side(west);
     -+loads(1);
     !errand;
     !assert_did(navigate_to(-3.4, 1.5, 0), 1);
     !assert_did(navigate_to(-2.4, 1.5, 0), 1);
     !assert_did(navigate_to(2.4, 1.5, 0), 1);
     !assert_did(navigate_to(3.4, 1.5, 180), 1);
     !assert_did(navigate_to(-2.4, 1.5, 180), 1);
     !assert_printed("linen 1 is in the ward");
     !assert_true(brought(1));
     !assert_true(side(west));
     !assert_did(.stopMAS, 1).

@has_nothing_to_unload_when_it_begins_in_the_ward[test]
+!test_ward
  <- !fakes;
     +side(east);
     !!bring;
     .wait(3500);
     !assert_true(brought(0));
     !assert_false(loaded);
     .drop_desire(bring).

@gives_the_passage_back_when_it_is_across[test]
+!test_passage
  <- !fakes;
     +side(west);
     !cross(east);
     !assert_true(side(east));
     !pass.

@pass[needs(passage), policy(refuse)]
+!pass.
