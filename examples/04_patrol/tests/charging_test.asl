// Tests of charging; wheels and battery are faked.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.
+!use_artifact(_, _, _).
+!use_artifact(_, _).

{ include("../robot.asl") }

// Driving takes one second and charging two, in virtual time.
+!fakes
  <- !fake_action(driveTo(_, _), after(1000));
     !fake_action(operationRecharge, after(2000));
     !fake_action(.stopMAS);
     !fake_action(.stopMAS(_, _)).

// What the battery does in the dock.
+recharges(1) <- -+battery(100).

@goes_to_the_dock_when_the_battery_is_low[test]
+!test_low
  <- !fakes;
     +battery(19);
     +diagnostics("Low Battery");
     !assert_did(driveTo(1, 1), 1);
     !assert_did(operationRecharge, 1);
     !assert_true(recharges(1));
     !assert_true(lowest(19)).

@does_not_charge_for_other_news_of_the_battery[test]
+!test_medium
  <- !fakes;
     +battery(50);
     +diagnostics("Medium Battery");
     !assert_not_did(driveTo(_, _)).

@stops_on_its_way_and_goes_on_to_the_same_corner[test]
+!test_way
  <- !fakes;
     !!patrol([1, 2, 3, 4]);
     .wait(500);  // on its way to the first corner
     ++battery(19);
     ++diagnostics("Low Battery");
     .wait(100);
     !assert_true(.intention(_, suspended));
     .wait(recharges(1), 10000);
     .wait(100);
     !assert_false(.intention(_, suspended));
     !assert_printed("battery low on the way to corner 1");
     !assert_printed("battery full, on to corner 1");
     .wait(visits(1), 10000);
     !assert_true(next(2)).

@asks_for_help_when_it_misses_the_dock[test]
+!test_missed
  <- !fakes;
     !fake_action(driveTo(1, 1), failed(blocked, "something stands in my way"));
     +battery(19);
     +diagnostics("Low Battery");
     !assert_printed("I am stuck: blocked");
     !assert_printed("I need help: something stands in my way");
     !assert_did(.stopMAS(0, 1));
     !assert_not_did(operationRecharge).
