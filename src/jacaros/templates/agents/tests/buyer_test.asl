// Tests of buyer.asl: run them with `jacaros test`.

{ include("$jacaros/tester_agent.asl") }

+!order(What) <- +ordered(What).  // before the include: no message is sent

{ include("../buyer.asl") }

@buys_what_it_can_afford[test]
+!test_cheap
  <- ++offer("lamp", 6);
     .wait(100);
     !assert_true(ordered("lamp")).

@waits_while_it_is_too_expensive[test]
+!test_expensive
  <- ++offer("lamp", 8);
     .wait(100);
     !assert_false(ordered(_));
     !assert_printed("8 is too much for a lamp").
