"""Needs, goal conditions and sub-plans cost only the plans that use them."""

from recording_host import RecordingHost, mind

from jacaros.agents.mind.rules import clr_int, forks, needs
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.terms.values import SOURCE_PERCEPT, atom

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


def test_the_branches_of_a_fork_react_with_the_sub_plans_of_their_goal():
    host = mind("!s. +!s <- (.wait({+n1}) |&| .wait({+n2})). { +y <- .print(y). }")
    host.run()
    perceive(host, "y")
    assert host.printed == ["y", "y"]
