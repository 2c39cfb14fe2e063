"""Two features that meet: handlers and scopes, forks and resources, goal conditions and faults, queues and limits."""

import pytest
from recording_host import RecordingHost, mind, printed

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.internal_action import ActionError
from jacaros.agents.mind.rules.goals import WatchedGoal
from jacaros.agents.mind.rules.meta_events import observe_goals, observe_mind
from jacaros.agents.mind.state.act import Act, Completion, Percept, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.values import SOURCE_PERCEPT, structure


def message(performative: str, content: str) -> SpeechAct:
    return SpeechAct(performative, "friend", "tester", lower_value(parse_term(content)), "m1")


def percept(name: str, value: float) -> Percept:
    return Percept("add", structure(name, value), (SOURCE_PERCEPT,))


def needs_granted(act: Act) -> Completion | None:
    return Completion(True) if act.functor.name == ".needs" else None


def test_scopes_deadlines_and_stacks_choose_the_nearest_plan():
    # Jason handles it there again, for ever.
    host = mind(
        """
        !g.
        +!g <- .fail.
        -!g <- .print(handles_g); !h.
        +!h <: false <- !s; .print(not_reached). { +!s <- .fail. }
        -!h <- .print(handles_h); .stopMAS.
        """
    )
    host.run(fuel=100)
    assert host.printed == ["handles_g", "handles_h"]
    host = mind(
        """
        !g(2).
        +!g(0) <- .wait(100).
        +!g(N) <: false <- !g(N - 1). { +e(_) <- .print(reacts(N)). }
        """
    )
    host.run(seconds=0.05)
    host.agent.perceive([percept("e", 1.0)])
    host.run(seconds=0.01)
    assert host.printed == ["reacts(1)"]
    assert printed(
        """
        !start.
        +!start <- !g[within(50)]; .print(after).
        @p[within(5000)] +!g <- .wait(1000); .print(late).
        -!g[error(E)] <- .print(E).
        """
    ) == ["deadline", "after"]


def test_the_first_branch_of_an_atomic_plan_is_not_interrupted():
    lines = printed(
        """
        !g. !other.
        @p[atomic] +!g <- (.print(a1); .print(a2); .print(a3)) |&| (.print(b1); .print(b2)).
        +!other <- .print(o1); .print(o2).
        """
    )
    assert lines[:3] == ["a1", "a2", "a3"]
    assert sorted(lines[3:]) == ["b1", "b2", "o1", "o2"]


def test_branches_keep_what_their_plan_needs_until_the_last_has_ended():
    host = mind(
        "!g. @p[needs(arm)] +!g <- (.wait(10); .print(first)) |&| (.wait(50); .print(second)); .print(both).",
        complete=needs_granted,
    )
    host.run(seconds=0.03)
    assert host.printed == ["first"]
    assert host.cancelled == []
    host.run()
    assert host.printed == ["first", "second", "both"]
    assert host.cancelled == [host.acts[0].id]
    host.agent.receive(message("tell", "p"))
    host.run()
    assert len(host.cancelled) == 1


def test_a_goal_condition_that_cannot_be_evaluated_is_reported_once_and_looked_at_again():
    host = mind(
        """
        n(0). !start.
        +!start <- !g; .print(after).
        +!g <: n(N) & 5 div N > 1 <- .wait(50); -+n(5); .print(five); .wait(50); -+n(2); .wait(50); .print(late).
        """
    )
    host.run()
    assert host.printed == ["five", "after"]
    assert [text for level, text in host.logged if level == "error"] == [
        "goal condition of plan p__2 skipped: ArithmeticFault: integer division by zero"
    ]


def test_messages_are_read_one_in_a_cycle_unless_they_are_urgent():
    host = mind("")
    for _ in range(3):
        host.agent.receive(message("sing", "p"))
    host.agent.run(2)
    assert len(host.logged) == 2
    assert len(host.agent.incoming.messages) == 1
    host = mind("@s[urgency(5)] +bump(_) <- .print(bump). +low(N) <- .print(N).")
    host.agent.receive(message("tell", "bump(1)"))
    host.agent.run(5)
    for number in range(3):
        host.agent.receive(message("tell", f"low({number})"))
    host.agent.run(1)
    assert host.printed[0] == "bump"
    assert len(host.agent.incoming.messages) == 2


def test_a_change_is_untaken_while_its_event_waits():
    host = mind("+p(_) <- true; true. +q(_) <- true; true.")
    host.agent.perceive([percept("p", 1.0), percept("q", 1.0)])
    host.agent.run(1)
    assert host.agent.has_untaken("q")
    assert not host.agent.has_untaken("r")
    host.run()
    assert not host.agent.has_untaken("q")


def test_a_program_included_at_run_time_must_not_take_a_label(tmp_path):  # type: ignore[no-untyped-def]
    (tmp_path / "more.asl").write_text("@same +!h <- .print(other).\n@free +!k <- true.\n")
    (tmp_path / "again.asl").write_text("@same +!h <- .print(own).\n@added +!k <- .print(k).\n")

    class Files(RecordingHost):
        def read_program(self, path: str) -> tuple[str, str]:
            return path, (tmp_path / path).read_text()

    host = mind("@same +!h <- .print(own).")
    host.__class__ = Files
    plans = len(host.agent.library.plans)
    with pytest.raises(ActionError, match="another plan has the label same"):
        host.agent.include("more.asl")
    assert len(host.agent.library.plans) == plans
    host.agent.include("again.asl")
    assert len(host.agent.library.plans) == plans + 1


def test_input_waits_for_its_cycle_in_an_agent_that_looks_around_rarely():
    steps = "; ".join(f".print({number})" for number in range(12))
    host = mind(f"!g. +!g <- {steps}. +p(_) <- .print(p).", options=Options(percept_interval=10))
    host.agent.run(2)
    host.agent.perceive([percept("p", 1.0)])
    host.agent.run(5)
    assert len(host.agent.incoming.percepts) == 1
    host.agent.run(6)
    assert len(host.agent.incoming.percepts) == 0
    host.run()
    assert "p" in host.printed


def test_an_observer_hears_of_a_goal_without_a_plan_in_each_attempt_of_the_goal_around_it():
    host = mind("!start. +!start <- !g[retry(2)]. +!g <- !h. -!start <- .print(handled).")
    states: list[tuple[str, str]] = []
    observe_goals(
        host.agent, lambda state, goal, number, intention, why: states.append((goal[0].functor.name, state))
    )
    host.run()
    assert host.printed == ["handled"]
    assert [state for name, state in states if name == "h"] == ["failed", "finished"] * 3


def test_an_observer_of_beliefs_does_not_hear_signals():
    class Observer:
        changes: list[str] = []  # noqa: RUF012 - one test has one observer

        def __getattr__(self, name: str) -> object:
            return lambda *arguments: None

        def changed(self, operator: str, symbol: object, *rest: object) -> None:
            del rest
            self.changes.append(f"{operator}{symbol}")

    host = mind("+p(_) <- .print(p). +s(_) <- .print(s).")
    observe_mind(host.agent, Observer())  # type: ignore[arg-type]
    host.agent.perceive([percept("p", 1.0), Percept("signal", structure("s", 1.0), (SOURCE_PERCEPT,))])
    host.run()
    assert host.printed == ["p", "s"]
    assert Observer.changes == ["+p/1"]


def test_beliefs_are_literals_and_watched_goals_end_with_their_plans():
    host = mind("")
    assert not host.agent.tell(3.0)
    assert not host.agent.untell(3.0)
    assert host.agent.untell(structure("p", 1.0)) is False
    host = mind("+!g <- .wait(10).")
    goal = WatchedGoal(host.agent, lower_value(parse_term("g")))
    host.run(seconds=0.005)
    assert not goal.achieved
    host.run()
    assert goal.achieved
    host = mind("!g. +!g <- .findall(X, .range(_, 1, 60) & X = math.random(10), L); .max(L, M); .print(M).")
    host.run()
    assert 3 < float(host.printed[0]) < 10


@pytest.mark.parametrize(
    ("step", "error"), [("+X", "body_var_without_value"), ("+3", "body_var_not_literal")]
)
def test_a_belief_must_be_a_literal(step, error):
    program = f"!g({'X' if 'X' in step else '3'}). +!g(X) <- +X. -!g(_)[error(E)] <- .print(E)."
    assert printed(program) == [error]
