// A test with a simulated robot; test_dock.jcm selects its world.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.

{ include("../robot.asl") }

@patrols_until_the_battery_is_low_and_charges_in_the_dock[test, timeout(300000)]
+!test_one_recharge
  <- +ready;
     !start;
     .wait(recharges(1), 200000);
     ?battery(Percent);
     !assert_greater_than(Percent, 95);
     ?lowest(Least);
     !assert_between(Least, 5, 20).
