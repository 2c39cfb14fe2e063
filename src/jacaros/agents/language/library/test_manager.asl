// The agent that manages the tests of a Jason project.  `jacaros test FOLDER` runs the tests instead: its goal only prints a
// line.

@test__create_tester_agents
+!create_tester_agents(_, _)
  <- .print("run the tests of this project with jacaros test").

@test__create_tester_agents_ignoring
+!create_tester_agents(_, _, _)
  <- .print("run the tests of this project with jacaros test").
