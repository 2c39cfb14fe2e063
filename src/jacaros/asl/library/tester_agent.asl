// What a file of agent tests takes in, by any of the names that Jason's users write:
//
//     { include("$jacaros/tester_agent.asl") }
//
// `jacaros test FILE` runs its plans whose label says `test`.

{ include("$jacaros/test_assert.asl") }
{ include("$jacaros/test_performance.asl") }

// Programs written for Jason ask for it; `jacaros test` has its own way, and leaves this goal out.
@test__execute_test_plans
+!execute_test_plans
  <- .print("run the tests of this agent with jacaros test").
