"""External actions: waiting, outputs, failure, suspension, dropping."""

import pytest
from recording_host import printed

from jacaros.agents.mind.state.act import Act, Completion
from jacaros.testing import ActionFailed, AgentHarness

MOVE = "!g. !other. +!g <- move(1, X); .print(moved(X)). +!other <- .wait(5); .print(other). -!g[R] <- .print(bad)."


def begun(program: str) -> AgentHarness:
    agent = AgentHarness(program)
    agent.run(seconds=0.001)
    return agent


def test_an_action_suspends_only_its_intention_and_binds_its_outputs():
    agent = AgentHarness(MOVE)
    agent.run()
    assert agent.prints == ["other"]
    assert [str(act) for act in agent.acts] == ["move(1,X)"]
    agent = begun(MOVE)
    agent.act("move").complete(7)
    agent.run()
    assert agent.prints == ["moved(7)", "other"]


def test_a_variable_can_be_the_namespace_of_an_action():
    agent = AgentHarness("!g(room). +!g(N) <- N::move(1, X); .print(N, X).")
    agent.run(seconds=0.001)
    assert [str(act) for act in agent.acts] == ["room::move(1,X)"]
    agent.act("move").complete(7)
    agent.run()
    assert agent.prints == ["room7"]


def test_an_action_that_ends_immediately_takes_one_turn():
    agent = AgentHarness(
        "!g. +!g <- a; .print(1); b; .print(2).", actions={"a": lambda: True, "b": lambda: True}
    )
    agent.run()
    assert agent.prints == ["1", "2"]
    agent = AgentHarness(TURNS, actions={"act": lambda: True})
    agent.run()
    assert agent.prints == ["a1", "b1", "a2", "b2", "b3", "a3", "b4", "b5"]
    agent = AgentHarness(TURNS.replace("+!a", "@a[atomic] +!a"), actions={"act": lambda: True})
    agent.run()
    assert agent.prints == ["a1", "a2", "a3", "b1", "b2", "b3", "b4", "b5"]

    def look() -> bool:
        agent.perceive("seen(cup)")
        return True

    agent = AgentHarness("!a. +!a <- look; ?seen(X); .print(X).", actions={"look": look})
    agent.run()
    assert agent.prints == ["cup"]


def test_a_failure_reaches_the_plan_with_its_reason():
    def refuse(metres: int) -> None:
        raise ActionFailed("limit(3)", "too far")

    agent = AgentHarness(
        """
        !g.
        +!g <- .print(go);
          move(9).
        -!g[error(E), error_msg(M), env_failure_reason(R), code(C), code_line(L)] <-
          .print(E, " ", M, " ", R, " ", C, " ", L).
        """,
        actions={"move": refuse},
    )
    agent.run()
    assert agent.prints == ["go", "action_failed too far limit(3) move(9) 4"]


def test_dropping_cancels_an_action_and_a_second_completion_is_ignored():
    agent = begun("!g. !d. +!g <- move; .print(done). +!d <- .wait(10); .drop_intention(g).")
    agent.run()
    assert agent.acts[0].cancelled
    with pytest.raises(ValueError, match="has already ended with its intention"):
        agent.acts[0].complete()
    agent.mind.complete(1, Completion(True))
    agent.run()
    assert agent.prints == []
    agent = begun("!g. +!g <- move; .print(done).")
    for _ in range(2):
        agent.mind.complete(1, Completion(True))
    agent.run()
    assert agent.prints == ["done"]


def test_suspending_the_intention_suspends_the_action():
    agent = begun("!g. !d. +!g <- move; .print(done). +!d <- .wait(10); .suspend(g); .wait(10); .resume(g).")
    move = agent.act("move")
    agent.run(seconds=0.015)
    assert move.paused
    agent.run()
    assert not move.paused
    assert agent.prints == []
    move.complete()
    agent.run()
    assert agent.prints == ["done"]
    agent = begun("!g. +!g <- move; .print(done). +!s <- .suspend(g). +!r <- .resume(g).")
    agent.achieve("s")
    agent.run()
    agent.act("move").complete()
    agent.run()
    assert agent.prints == []
    agent.achieve("r")
    agent.run()
    assert agent.prints == ["done"]


TURNS = """
    !a. !b.
    +!a <- .print(a1); act; .print(a2); act; .print(a3).
    +!b <- .print(b1); .print(b2); .print(b3); .print(b4); .print(b5).
    +seen(X) <- .print(seen(X)).
"""


def test_an_output_of_an_immediate_action_is_bound_or_fails_the_step():
    program = """
        !a.
        +!a <- get(X, X2); .print(X, X2); get(Y, Y); .print(no).
        -!a[error(E), error_msg(M), env_failure_reason(R)] <- .print(E, " ", R, ": ", M).
    """

    def give(act: Act) -> Completion:
        return Completion(True, tuple(zip(act.arguments, (3.0, 4.0), strict=True)))

    assert printed(program, complete=give) == [
        "34",
        'action_failed bind_param_error(3,"4"): an output of the action would be 4, but is 3 already',
    ]
