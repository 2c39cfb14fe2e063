"""Plans of a program that its agents share, and features that cost only the plans that have them."""

import pytest
from recording_host import RecordingHost, mind, printed

from jacaros.agents.language.loader import load_program, parse_literals
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.mind import Mind, new_engine
from jacaros.agents.mind.rules import clr_int, forks, needs
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.terms.values import SOURCE_PERCEPT, atom

PROGRAM = """
+!greet(X) <- .print("hello ", X).
+!learn <- .add_plan({ +!greet(X) : X == bob <- .print("hi ", X) }, self, begin).
+!forget <- .remove_plan(p__1).
@told +!tell(X) <- .print(told).
+!slow <- .wait(10); .add_plan({ +!slow : other }); .wait(10); ?missing; .print(never).
-!slow[code_line(L), error(E)] <- .print(E, " in line ", L).
+!both <- !greet(bob); !learn; !greet(bob).
"""


def agents(*names: str) -> list[RecordingHost]:
    """Agents that share the plans of one program."""
    program, _ = load_program("shared.asl", PROGRAM, lambda wanted, including: (wanted, ""))
    plans = ProgramPlans(program.plans, new_engine(STANDARD))
    hosts = []
    for name in names:
        host = RecordingHost(None)
        host.agent = Mind(name, program, host, plans=plans)
        host.agent.start()
        hosts.append(host)
    return hosts


def adopt(host: RecordingHost, goal: str) -> None:
    """Let an agent adopt a goal, and run."""
    host.agent.post_goal(lower_value(parse_literals(goal, "test")[0]))
    host.run()


def test_select_functions_are_made_once_and_shared():
    first, second = agents("a", "b")
    adopt(first, "greet(bob)")
    adopt(second, "greet(ann)")
    assert (first.printed, second.printed) == (["hello bob"], ["hello ann"])
    kinds = [
        kind for kind in first.agent.library.selects if kind.functor.name == "greet" and kind.operator == "+"
    ]
    assert first.agent.library.selects[kinds[0]] is second.agent.library.selects[kinds[0]]
    first, second = agents("a", "b")
    assert first.agent.library.selects is second.agent.library.selects
    assert first.agent.library.plans is second.agent.library.plans
    adopt(first, "learn")
    assert first.agent.library.selects is not second.agent.library.selects
    assert second.agent.library.selects is second.agent.library.program.selects
    adopt(second, "forget")
    assert second.agent.library.selects is second.agent.library.selects
    assert second.agent.library.selects is not second.agent.library.program.selects
    assert len(second.agent.library.program.plans) == len(second.agent.library.plans) + 1


def test_added_and_removed_plans_count_for_that_agent():
    (only,) = agents("a")
    adopt(only, "both")
    assert only.printed == ["hello bob", "hi bob"]
    first, second = agents("a", "b")
    adopt(first, "greet(bob)")
    adopt(first, "learn")
    adopt(first, "greet(bob)")
    adopt(second, "greet(bob)")
    assert first.printed == ["hello bob", "hi bob"]
    assert second.printed == ["hello bob"]
    first, second = agents("a", "b")
    adopt(first, "forget")
    adopt(first, "greet(bob)")
    adopt(second, "greet(bob)")
    assert first.printed == []
    assert second.printed == ["hello bob"]


def test_running_plans_and_branches_keep_their_sub_plans():
    first, second = agents("a", "b")
    adopt(first, "slow")
    adopt(second, "slow")
    assert first.printed == second.printed == ["test_goal_failed in line 6"]
    host = mind("!s. +!s <- (.wait({+n1}) |&| .wait({+n2})). { +y <- .print(y). }")
    host.run()
    perceive(host, "y")
    assert host.printed == ["y", "y"]


@pytest.mark.parametrize("size", [30, 125, 1500])
def test_a_context_may_be_a_chain_of_any_length(size):
    beliefs = " ".join(f"ok({i})." for i in range(size - 1))
    conjunction = " & ".join(f"ok(X{i}) & X{i} == {i}" for i in range(size))
    disjunction = " | ".join(f"no({i})" for i in range(size))
    program = f"""
{beliefs}
!go.
+!go <- !both; +ok({size - 1}); !both; !either; +no({size - 1}); !either.
+!both : {conjunction} <- .print("all, ", X0, " to ", X{size - 1}).
+!both <- .print("not all").
+!either : {disjunction} <- .print("one").
+!either <- .print("none").
"""
    assert printed(program) == ["not all", f"all, 0 to {size - 1}", "none", "one"]


def test_plans_are_searched_or_run_although_nested_or_not_compiled():
    context = "".join("(ok & (no(X) | " for _ in range(70)) + "ok & Y = 3" + "))" * 70
    assert printed(f"!go. ok. +!go : {context} <- .print(Y). +!go <- .print(none).") == ["3"]
    deep = "[" * 140 + "X" + "]" * 140
    host = mind(f"""
        !go.
        +!go <- +bumper(left); +bumper({deep.replace("X", "5")}).
        +bumper({deep}) <- .print(X).
        +bumper(X) <- .print(stop).
    """)
    host.run()
    assert host.printed == ["stop", "5"]
    levels = {level for level, told in host.logged if "is too large to compile" in told}
    assert levels == {"warning"}


LOOP = "!c(50). +!c(0) <- .print(done). +!c(N) <- +left(N); -left(N); !c(N - 1). +e <- .print(e).\n"
UNUSED = """
@never[needs(wheels)] +!never.
+!until <: done <- +x.
+!around <- +x. { +y <- .print(y). }
"""


def perceive(host: RecordingHost, name: str) -> None:
    host.agent.perceive([Percept("signal", atom(name), (SOURCE_PERCEPT,))])
    host.run()


def test_plans_that_do_not_run_change_no_cycle(monkeypatch):
    def never(*_: object) -> None:
        raise AssertionError

    for module, name in ((clr_int, "_is_achieved"), (needs, "_wanted"), (forks, "_select")):
        monkeypatch.setattr(module, name, never)
    hosts = mind(LOOP), mind(LOOP + UNUSED)
    for host in hosts:
        host.run()
        perceive(host, "e")
        assert host.printed == ["done", "e"]
        assert not host.agent.incoming.called
    assert hosts[0].agent.counts.cycles == hosts[1].agent.counts.cycles


def test_an_event_is_offered_only_to_intentions_with_sub_plans_for_it(monkeypatch):
    host = mind(
        """
        !start.
        +!start <- for (.range(I, 1, 20)) { !!other(I) }; !!one.
        +!other(I) <- .wait({+never(I)}). { +x <- .print(x). }
        +!one <- .wait({+never}). { +y <- .print(y). }
        """
    )
    host.run()
    asked = []
    select = forks._select
    monkeypatch.setattr(forks, "_select", lambda *given: asked.append(given) or select(*given))
    perceive(host, "z")
    assert not asked
    perceive(host, "y")
    assert host.printed == ["y"]
    assert len(asked) == 1


def test_a_goal_condition_is_tested_only_while_its_goal_is_pursued():
    host = mind("!s. +!s <- !g; .print(over). +!g <: done <- .wait({+never}). +e <- +done.")
    host.run()
    assert host.agent.conditioned
    perceive(host, "e")
    assert host.printed == ["over"]
    perceive(host, "other")
    assert not host.agent.conditioned
    assert not host.agent.incoming.called
