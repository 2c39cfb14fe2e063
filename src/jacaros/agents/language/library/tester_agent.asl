// A file of agent tests includes this file, under any of the names that Jason programs use:
//
//     { include("$jacaros/tester_agent.asl") }
//
// `jacaros test FILE` runs the plans with `test` in their label.

{ include("$jacaros/test_assert.asl") }
{ include("$jacaros/test_performance.asl") }

// Programs written for Jason have this goal; `jacaros test` runs the tests without it, and skips it.
@test__execute_test_plans
+!execute_test_plans
  <- .print("run the tests of this agent with jacaros test").

// Create an agent for a test to exchange messages with; the test can kill it afterwards.
@test__create_mock_agent
+!create_mock_agent(Name) : .my_name(Me)
  <- .create_agent(Name, "mock_agent.asl");
     .send(Name, tell, mock_owner(Me)).

// Wait until a mock agent has handled the messages sent to it.
@test__wait_idle
+!wait_idle(Name)
  <- .wait(not sleeping(Name), 300, _);
     .wait(sleeping(Name)).
