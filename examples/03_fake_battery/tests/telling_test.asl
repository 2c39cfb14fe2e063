// Tests of the agent's reports; beliefs are enough, so no battery is needed.

{ include("$jacaros/tester_agent.asl") }

+!start : not ready.

{ include("../robot.asl") }

@tells_every_state_with_the_percentage[test]
+!test_states
  <- +battery(50);
     +diagnostics("Medium Battery");
     -+battery(20);
     -+diagnostics("Low Battery");
     !assert_printed("50 %: Medium Battery");
     !assert_printed("20 %: Low Battery").

@stops_when_the_battery_is_empty[test]
+!test_empty
  <- !fake_action(.stopMAS);
     +battery(0);
     !assert_printed("0 %: empty");
     !assert_did(.stopMAS).

@does_not_stop_with_one_percent_left[test]
+!test_nearly_empty
  <- !fake_action(.stopMAS);
     +battery(1);
     !assert_not_did(.stopMAS).

// With the real artifact: a timer drains the battery by one percent per second of the run's clock.
@a_timer_drains_the_battery[test]
+!test_timer
  <- +ready;
     !start;
     .wait(battery(90), 20000);
     !assert_true(battery(90)).
