// Tests of teacher.asl: run them with `jacaros test`.

{ include("$jacaros/tester_agent.asl") }

+!ask(N) <- +asked(N).  // before the include: no message is sent

{ include("../src/agt/teacher.asl") }

@counts_a_correct_answer[test]
+!test_correct
  <- ++answer(1, 42)[source(pupil)];
     .wait(100);
     !assert_true(correct(1));
     !assert_true(asked(2)).

@does_not_count_a_wrong_answer[test]
+!test_wrong
  <- ++answer(1, 41)[source(pupil)];
     .wait(100);
     !assert_true(correct(0));
     !assert_printed("wrong: 41").
