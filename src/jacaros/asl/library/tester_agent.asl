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

// Another agent for a test to talk to; the test may kill it when it is done.
@test__create_mock_agent
+!create_mock_agent(Name) : .my_name(Me)
  <- .create_agent(Name, "mock_agent.asl");
     .send(Name, tell, mock_owner(Me)).

// Wait until such an agent has dealt with what it has been sent.
@test__wait_idle
+!wait_idle(Name)
  <- .wait(not sleeping(Name), 300, _);
     .wait(sleeping(Name)).
