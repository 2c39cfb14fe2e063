// Assertion goals for tests.  `jacaros test` adds them to every agent that it tests; include them in other programs:
//
//     { include("$jacaros/test_assert.asl") }
//
// A failed assertion is logged, and the plan continues. All plans have labels, so the file may be included twice.

// Equal terms; lists are equal when they have the same elements, in any order.
@test__assert_equals[atomic]
+!assert_equals(Expected, Actual)
  <- jacaros.assert_equals(Expected, Actual).

// Numbers that differ by at most the tolerance.
@test__assert_equals_tolerance[atomic]
+!assert_equals(Expected, Actual, Tolerance)
  <- jacaros.assert_equals(Expected, Actual, Tolerance).

@test__assert_not_equals[atomic]
+!assert_not_equals(Unwanted, Actual)
  <- jacaros.assert_not_equals(Unwanted, Actual).

// Any formula, as in the context of a plan.
@test__assert_true[atomic]
+!assert_true(Formula)
  <- jacaros.assert_true(Formula).

@test__assert_false[atomic]
+!assert_false(Formula)
  <- jacaros.assert_false(Formula).

// A list or a set.
@test__assert_contains[atomic]
+!assert_contains(Collection, Item)
  <- jacaros.assert_contains(Collection, Item).

@test__assert_not_contains[atomic]
+!assert_not_contains(Collection, Item)
  <- jacaros.assert_not_contains(Collection, Item).

// Numbers.
@test__assert_greater_than[atomic]
+!assert_greater_than(A, B)
  <- jacaros.assert_greater_than(A, B).

@test__assert_greater_than_equals[atomic]
+!assert_greater_than_equals(A, B)
  <- jacaros.assert_greater_than_equals(A, B).

@test__assert_between[atomic]
+!assert_between(X, Least, Most)
  <- jacaros.assert_between(X, Least, Most).

@test__force_pass[atomic]
+!force_pass
  <- jacaros.force_pass.

@test__force_failure[atomic]
+!force_failure(Message)
  <- jacaros.force_failure(Message).

/* Assertions that Jason does not have */

// The goal fails, for any reason.
@test__assert_fail
+!assert_fail(Goal)
  <- !Goal;
     jacaros.assert_fail(Goal, achieved).

@test__assert_fail_failed
-!assert_fail(Goal)
  <- jacaros.assert_fail(Goal, failed).

// Fake an external action from now on: it succeeds immediately, or ends with the given outcome.
@test__fake_action[atomic]
+!fake_action(Action)
  <- jacaros.fake(Action).

@test__fake_action_outcome[atomic]
+!fake_action(Action, Outcome)
  <- jacaros.fake(Action, Outcome).

// The agent has started a matching external action since the test began.
@test__assert_did[atomic]
+!assert_did(Action)
  <- jacaros.assert_did(Action).

@test__assert_did_times[atomic]
+!assert_did(Action, Times)
  <- jacaros.assert_did(Action, Times).

@test__assert_not_did[atomic]
+!assert_not_did(Action)
  <- jacaros.assert_not_did(Action).

// The agent has printed a line that contains this text.
@test__assert_printed[atomic]
+!assert_printed(Text)
  <- jacaros.assert_printed(Text).
