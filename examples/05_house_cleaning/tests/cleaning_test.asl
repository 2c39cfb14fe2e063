// Tests of cleaning; wheels, battery and household are faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.

{ include("../robot.asl") }

+!fakes
  <- !fake_action(driveTo(_, _), after(1000));
     !fake_action(clean(_), after(5000));
     !fake_action(rotate(_));
     !fake_action(operationRecharge, after(2000));
     !fake_action(updateWhereAmI);
     !fake_action(.stopMAS).

// What the battery does in the dock.
+recharges(N) : N > 0 <- -+battery(100).

@cleans_the_room_that_it_is_in[test]
+!test_room
  <- !fakes;
     !clean_room(2, kitchen);
     !assert_did(clean(2), 1).

@counts_a_round_in_the_hallway[test]
+!test_round
  <- !fakes;
     !clean_room(0, hallway);
     !assert_not_did(clean(_));
     !assert_true(done(1));
     !assert_printed("hallway: round 1 is done").

@comes_back_to_its_room_after_a_recharge[test]
+!test_return
  <- !fakes;
     +atRoom(3);
     +diagnostics("Low Battery");
     !assert_did(driveTo(1, 1), 1);
     !assert_did(operationRecharge, 1);
     !assert_printed("back to the bathroom");
     !assert_did(driveTo(0, 2), 1).

@cleans_in_its_room_though_the_battery_was_low_when_it_arrived[test]
+!test_arrival
  <- !fakes;
     +atRoom(2);
     !!clean_house;
     .wait(1000);
     !assert_did(driveTo(2, 2), 1);
     +diagnostics("Low Battery");
     !assert_did(driveTo(1, 1), 1);
     !assert_did(driveTo(2, 2), 2);
     .wait(2000);  // it is on its way back
     !assert_did(clean(2), 1).

@waits_before_a_closed_door[test]
+!test_door
  <- !fakes;
     !fake_action(driveTo(2, 2), failed(blocked(0.5), "something is in the way"));
     +atRoom(2);
     !!clean_house;
     .wait(5000);
     !assert_printed("something is in my way to the kitchen");
     !assert_not_did(clean(_));
     !fake_action(driveTo(2, 2));
     .wait(3000);
     !assert_did(clean(2), 1).

@stops_after_its_rounds[test]
+!test_end
  <- !fakes;
     -+done(4);
     -+recharges(3);
     !clean_house;
     !assert_printed("The house is clean: 4 rounds, the battery charged 3 times.");
     !assert_did(.stopMAS);
     !assert_not_did(updateWhereAmI).

@tells_what_it_does[test]
+!test_telling
  <- +vacuum("", kitchen);  // nothing yet
     +vacuum("carpet", kitchen);
     !assert_printed("kitchen: vacuum the carpet").
