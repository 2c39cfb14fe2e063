// The agent that leads a Jason project of tests.  `jacaros test PROJECT` finds the folder of the tests in its goal
// create_tester_agents(Folder, Pattern) and runs them; in any other run it does nothing.

@test__create_tester_agents
+!create_tester_agents(_, _)
  <- .print("run the tests of this project with jacaros test").

@test__create_tester_agents_ignoring
+!create_tester_agents(_, _, _)
  <- .print("run the tests of this project with jacaros test").
