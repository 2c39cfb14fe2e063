"""The harness that puts one agent under the control of a Python test."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.terms.values import atom
from jacaros.artifacts.env.values import Atom
from jacaros.testing import ActionFailed, AgentHarness

ROBOT = """
    dock(1, 2).
    +battery(Level) : Level < 20 <- !charge.
    +!charge : dock(X, Y) <- driveTo(X, Y); +docked; .print("charging").
    -!charge[env_failure_reason(R)] <- .print("no way: ", R); .send(boss, tell, stuck(R)).
"""


@pytest.fixture
def robot() -> AgentHarness:
    return AgentHarness(ROBOT, name="robot")


def test_percepts_lead_to_acts_that_the_test_ends(robot: AgentHarness) -> None:
    robot.perceive("battery(15)")
    robot.run()
    robot.assert_believes("battery(15)[source(percept)]", "battery(L) & L < 20")
    robot.assert_pursues("charge")
    robot.assert_did("driveTo(1, _)")
    assert robot.act("driveTo").arguments == (1, 2)
    robot.act("driveTo(1, 2)").complete()
    robot.run()
    robot.assert_believes("docked")
    robot.assert_printed("charging")
    robot.assert_idle()


def test_acts_can_fail_with_a_reason(robot: AgentHarness) -> None:
    robot.perceive("battery(15)")
    robot.run()
    robot.act("driveTo").fail("blocked(wall)", "there is a wall")
    robot.run()
    assert robot.prints == ["no way: blocked(wall)"]
    robot.assert_sent("boss", "tell", "stuck(_)")
    robot.assert_sent_not("boss", "achieve", "_")
    robot.assert_believes_not("docked", "~docked")


def test_functions_can_answer_actions() -> None:
    def see(what: str) -> int:
        if what == "fog":
            raise ActionFailed("too_foggy")
        return len(what)

    agent = AgentHarness(
        """
        +!go <- see(cat, N); pose(X, Y); hold(N, X, Y); see(fog, _).
        -!go[error(E), env_failure_reason(R), error_msg(M)] <- .print(E, " ", R, " ", M); refuse(1).
        """,
        actions={
            "see": see,
            "pose": lambda: (1.5, Atom("left")),
            "hold": lambda *values: print(values),
            "refuse": lambda value: False,
        },
    )
    goal = agent.achieve("go")
    agent.run()
    assert [str(act) for act in agent.acts][:3] == ["see(cat,3)", "pose(1.5,left)", "hold(3,1.5,left)"]
    assert agent.prints == ["action_failed too_foggy too_foggy"]
    agent.assert_failed(goal, "env_failure_reason(failed)")


def test_the_test_decides_about_outputs() -> None:
    agent = AgentHarness("+!go <- ask(X, Y); .print(X, Y).")
    agent.achieve("go")
    agent.run()
    act = agent.act("ask")
    assert act.arguments == (None, None)
    with pytest.raises(ValueError, match="has 2 unbound variables, not 1"):
        act.complete(1)
    act.complete(1, "two")
    with pytest.raises(ValueError, match="has already ended"):
        act.complete()
    agent.run()
    assert agent.prints == ["1two"]


def test_goals_report_their_outcome() -> None:
    agent = AgentHarness(
        "+!good <- .wait(100). +!bad <- .fail(error(broken)). +!long <- .suspend. +!own <- do."
    )
    good, bad, missing, long, own = map(agent.achieve, ("good", "bad", "missing(1)", "long", "own"))
    assert good.state == "running"
    agent.step(30)
    assert good.state == "waiting"
    agent.run()
    agent.assert_achieved(good)
    agent.assert_failed(bad, "error(broken)")
    agent.assert_failed(missing, "error(no_relevant)")
    assert long.state == "suspended"
    agent.mind.drop_desire(atom("own"))
    assert own.state == "dropped"
    assert agent.acts[0].cancelled
    assert str(bad).startswith("!bad (failed: error(broken)")


def test_beliefs_can_be_given_and_taken() -> None:
    agent = AgentHarness("+p(X)[source(S)] <- .print(plus(X, S)). -p(X) <- .print(minus(X)).")
    agent.add_belief("p(1)")
    agent.add_belief("p(2)[source(bob)]")
    agent.run()
    agent.remove_belief("p(1)")
    agent.run()
    assert agent.prints == ["plus(1,self)", "plus(2,bob)", "minus(1)"]
    assert agent.beliefs == ["p(2)[source(bob)]"]


def test_percepts_can_be_added_removed_or_momentary() -> None:
    agent = AgentHarness("+door(X) <- .print(open(X)). -door(X) <- .print(closed(X)). +bump <- .print(bump).")
    agent.perceive("door(1)")
    agent.signal("bump")
    agent.run()
    agent.perceive_no_more("door(1)")
    agent.run()
    assert agent.prints == ["open(1)", "bump", "closed(1)"]
    assert agent.beliefs == []
    with pytest.raises(ValueError, match="a percept must be ground"):
        agent.perceive("door(_)")


def test_messages_are_received_and_answered() -> None:
    agent = AgentHarness(
        "age(42). +!greet(X)[source(S)] <- .send(S, tell, hello(X)). +ready[source(S)] <- .print(S)."
    )
    agent.receive("bob", "achieve", "greet(you)")
    agent.receive("bob", "tell", "ready")
    agent.receive("carl", "askOne", "age(X)")
    agent.run()
    agent.assert_sent("bob", "tell", "hello(you)")
    agent.assert_sent("carl", "tell", "age(42)")
    assert agent.prints == ["bob"]


def test_only_known_agents_can_be_reached_when_they_are_named() -> None:
    agent = AgentHarness("+!go <- .send(bob, tell, a); .send(carl, tell, b).", others=["bob"])
    goal = agent.achieve("go")
    agent.run()
    assert [repr(message) for message in agent.sent] == [".send(bob, tell, a)"]
    agent.assert_failed(goal, "error(receiver_not_found)")


def test_time_is_virtual_and_moves_as_the_test_wants() -> None:
    agent = AgentHarness("!tick(1). +!tick(N) <- .print(N); .wait(1000); !tick(N + 1).")
    agent.step()
    assert agent.prints == ["1"]
    agent.run(seconds=2.5)
    assert agent.prints == ["1", "2", "3"]
    assert agent.time == 2.5
    agent.run(seconds=0.5)
    assert agent.prints[-1] == "4"
    with pytest.raises(AssertionError, match="not idle after an hour"):
        agent.run()


def test_a_run_ends_when_nothing_is_left() -> None:
    agent = AgentHarness("!go. +!go <- .wait(1000); .print(done); do(it).")
    agent.run()
    assert agent.prints == ["done"]
    assert agent.time == 1.0


def test_an_endless_loop_fails() -> None:
    with pytest.raises(AssertionError, match="an endless loop"):
        AgentHarness("!go. +!go <- !go.").run()


def test_a_program_may_end_the_run() -> None:
    agent = AgentHarness("!go. +!go <- .stopMAS(500, 3); .print(still); .wait(1000); .print(late).")
    agent.run()
    assert (agent.exit_code, agent.prints, agent.time) == (3, ["still"], 0.5)
    assert not agent.step()


def test_answers_are_plain_values() -> None:
    agent = AgentHarness('p(1, "one"). p(2, [a, f(1.5)]). q(X) :- p(X, _).')
    assert agent.answers("p(N, V)")[0] == {"N": 1, "V": "one"}
    assert agent.answers("q(X) & X > 1") == [{"X": 2}]
    assert agent.answers("p(1, _)") == [{}]
    assert agent.answers("p(3, _)") == []
    assert agent.mind.trail == []


def test_all_goals_of_an_intention_are_pursued() -> None:
    agent = AgentHarness("!a. !x. +!a <- !b(1). +!b(N) <- do(N). +!x <- do(2).")
    agent.run()
    assert sorted(agent.goals) == ["a", "b(1)", "x"]
    agent.assert_pursues_not("c")


def test_suspended_intentions_pause_their_acts() -> None:
    agent = AgentHarness("+!go <- drive. +!stop <- .suspend(go). +!on <- .resume(go).")
    agent.achieve("go")
    agent.run()
    agent.achieve("stop")
    agent.run()
    assert agent.act("drive").paused
    agent.achieve("on")
    agent.run()
    assert not agent.act("drive").paused


def test_a_program_can_be_a_file_with_includes(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "more.asl").write_text("+!more <- .print(more).", encoding="utf-8")
    (tmp_path / "main.asl").write_text('{ include("more.asl") } !more.', encoding="utf-8")
    agent = AgentHarness(tmp_path / "main.asl", folders=[tmp_path / "lib"])
    agent.run()
    agent.assert_printed("more")


def test_a_program_with_errors_raises() -> None:
    with pytest.raises(AslError, match=r"agent\.asl:1:"):
        AgentHarness("+!go <- .print(.")


@pytest.mark.parametrize(
    ("check", "told"),
    [
        (lambda a: a.assert_believes("p(2)"), "it does not believe p(2)"),
        (lambda a: a.assert_believes_not("p(_)"), "it believes p(_)"),
        (lambda a: a.assert_pursues("fly"), "it does not pursue !fly"),
        (lambda a: a.assert_pursues_not("go"), "it pursues !go"),
        (lambda a: a.assert_idle(), "it is not idle"),
        (lambda a: a.assert_printed("bye"), "it did not print 'bye'"),
        (lambda a: a.assert_printed_not("hello"), "it printed 'hello'"),
        (lambda a: a.assert_did("drive(2)"), "it did not do drive(2)"),
        (lambda a: a.assert_did("drive(1)", "drive(1)"), "it did not do drive(1), drive(1) in this order"),
        (lambda a: a.assert_did_not("drive(_)"), "it did drive(_)"),
        (lambda a: a.assert_sent("bob", "tell", "bye"), "it did not send tell bye to bob"),
        (lambda a: a.assert_sent_not("bob", "tell", "hi"), "it sent tell hi to bob"),
        (lambda a: a.act("fly"), "no pending action fly"),
        (lambda a: a.assert_achieved(a.achieve("go")), "not achieved: !go (running)"),
        (lambda a: a.assert_failed(a.achieve("go")), "it did not fail: !go (running)"),
    ],
)
def test_failures_show_all_that_can_be_seen_of_the_agent(
    check: Callable[[AgentHarness], None], told: str
) -> None:
    agent = AgentHarness("p(1). !go. +!go <- .print(hello); .send(bob, tell, hi); drive(1).", name="robot")
    agent.run()
    with pytest.raises(AssertionError) as failure:
        check(agent)
    lines = str(failure.value).splitlines()
    assert lines[0] == told
    shown = "\n".join(lines[1:])
    for part in (
        "p(1)[source(self)]",
        "!go",
        "drive(1) (pending)",
        ".send(bob, tell, hi)",
        "hello",
        "robot at 0 s",
    ):
        assert part in shown


def test_a_different_reason_fails() -> None:
    agent = AgentHarness("+!go <- .fail(error(a)).")
    goal = agent.achieve("go")
    agent.run()
    with pytest.raises(AssertionError, match=r"another reason than error\(b\): !go \(failed: error\(a\)"):
        agent.assert_failed(goal, "error(b)")


def test_exceptions_of_answering_functions_reach_the_test() -> None:
    def see(thing: object) -> None:
        assert thing == Atom("dog"), "no dog"

    agent = AgentHarness("!go. +!go <- see(cat). -!go <- .print(caught).", actions={"see": see})
    with pytest.raises(AssertionError, match="no dog"):
        agent.run()
    stepped = AgentHarness("!go. +!go <- see(cat).", actions={"see": see})
    with pytest.raises(AssertionError, match="no dog"):
        stepped.step(10)


def test_sys_exit_in_a_coroutine_fails_the_step(tmp_path: Path) -> None:
    (tmp_path / "my.py").write_text(
        "import sys\nfrom jacaros import internal_action\n\n@internal_action\nasync def leave():\n    sys.exit(3)\n"
    )
    program = tmp_path / "t.asl"
    program.write_text("!go. +!go <- my.leave. -!go[error(E)] <- .print(E).")
    agent = AgentHarness(program)
    agent.run()
    agent.assert_printed("internal_action")
