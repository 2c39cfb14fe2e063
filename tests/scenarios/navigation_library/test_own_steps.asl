// A program that overrides each step of $jacaros/navigation.asl.

{ include("$jacaros/tester_agent.asl") }

+!drive_there(X, Y, _)
  <- driveTo(X, Y).

+!recover(_)
  <- +recovered.

+!drive_into_dock
  <- park.

+!drive_out_of_dock
  <- moveReverse(1).

+!wait_until_charged
  <- operationRecharge.

+!arrived(Place)
  <- +been(Place).

{ include("$jacaros/navigation.asl") }

place(a, 1, 0, 0).

@drives_in_its_own_way[test]
+!test_drive
  <- !fake_action(driveTo(_, _));
     !patrol([a], 1);
     !assert_did(driveTo(1, 0), 1);
     !assert_true(been(a)).

@recovers_in_its_own_way[test]
+!test_recover
  <- !fake_action(driveTo(_, _), failed(blocked, "blocked"));
     !assert_fail(go_to(a));
     !assert_did(driveTo(1, 0), 3);
     !assert_true(recovered).

@charges_in_its_own_way[test]
+!test_charge
  <- !fake_action(park);
     !fake_action(operationRecharge);
     !fake_action(moveReverse(_));
     !dock_and_charge;
     !assert_did(park, 1);
     !assert_did(operationRecharge, 1);
     !assert_did(moveReverse(1), 1).
