"""A mind is a value: stored as JSON and restored at any cycle, it continues as if nothing had happened."""

import base64
import json
import os
import pickle
import sys
from pathlib import Path
from random import Random

import pytest
from recording_host import RecordingHost, mind, plans_of

from jacaros.agents.language import nodes
from jacaros.agents.mind.mind import Mind, new_engine
from jacaros.agents.mind.state.act import Completion
from jacaros.agents.mind.storage import NotStorable, restore, stored
from jacaros.agents.terms.values import Reference, atom, structure
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.testing import run_project

sys.path.insert(0, str(Path(__file__).parents[4] / "tools"))

import run_restored

CASES = Path(__file__).parents[3] / "conformance"
PROGRAMS = Random(7).sample(
    sorted(
        path
        for pattern in ("*/*.asl", "*/*/*.mas2j")
        for path in CASES.glob(pattern)
        if path.parent.name != "syntax_errors"
    ),
    20,
)


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_program_prints_the_same_when_its_minds_are_restored(program, monkeypatch):
    """A sample; `tools/check_conformance.py restored` runs all programs."""
    expected = run_project(program, seconds=120)
    monkeypatch.setattr(AgentHost, "mind", run_restored.RESTORING)
    monkeypatch.setattr(run_restored, "CHANCE", 0.3)
    found = run_project(program, seconds=120)
    assert found.lines == expected.lines
    assert found.exit_code == expected.exit_code


def restored(host: RecordingHost, *, later: float = 0.0) -> Mind:
    """A new mind in the place of that of the host, whose clock differs by so many seconds."""
    old = host.agent
    text = json.dumps(stored(old))
    for alarm in old.waits.alarms.values():
        alarm.timer.cancel()
    host.time += later
    host.agent = Mind(
        old.name, old.program, host, old.options, plans=plans_of(old.program, old.engine.actions)
    )
    restore(host.agent, json.loads(text), same_host=True)
    return host.agent


def printed(program: str, *, exchanged: bool) -> list[str]:
    """What a program prints; if *exchanged*, its mind is restored after each cycle."""
    host = mind(program)
    more = True
    while more:
        more = host.agent.run(1)
        if exchanged:
            restored(host)
        more = more or host.ring_next(host.time + 10)
    return host.printed


def test_a_restored_mind_is_stored_as_the_same_data_and_keeps_what_it_needs():
    host = mind("b(1)[x]. b(X) :- c(X). !s. +!s <- .wait(1000).")
    host.agent.run(10)
    before = stored(host.agent)
    assert stored(restored(host)) == before
    host = mind("!g. @[needs(base)] +!g <- .wait(1000).", complete=lambda act: Completion(True))
    host.agent.run(10)
    restored(host)
    host.agent.run(10)
    assert host.cancelled == []
    host.run()
    assert host.cancelled == [1]


def test_an_intention_that_has_lost_a_resource_goes_on_at_another_host():
    host = mind("!g. @[needs(base)] +!g <- .wait(100); .print(done).", complete=lambda act: Completion(True))
    host.agent.run(10)
    host.agent.preempted(1, "base")
    host.agent.run(10)
    other = mind("!g. @[needs(base)] +!g <- .wait(100); .print(done).")
    data = json.loads(json.dumps(stored(host.agent)))
    other.agent = Mind("tester", host.agent.program, other, plans=plans_of(host.agent.program))
    restore(other.agent, data)
    other.run()
    assert other.printed == ["done"]


def test_the_time_of_an_agent_goes_on_when_the_clock_is_set_back():
    host = mind("!g. +!g <- .wait({+never}, 1000, T); .print(T).")
    host.agent.run(10)
    host.time += 0.6
    data = json.loads(json.dumps(stored(host.agent)))
    other = mind("")
    other.agent = Mind("tester", host.agent.program, other, plans=plans_of(host.agent.program))
    other.time -= 3600
    restore(other.agent, data)
    other.run()
    assert (other.printed, round(other.time - 1_577_836_800.0 + 3600, 3)) == (["1000"], 0.4)


def test_data_that_cannot_be_restored_are_refused():
    with pytest.raises(ValueError, match="format 0"):
        restore(mind("!s. +!s.").agent, {"format": 0})
    with pytest.raises(ValueError, match="not that of a stored mind"):
        tampered(pickle.dumps(Changed()))
    host = mind("!s. +!s.")
    host.agent.add_belief(structure("b", atom("x"))[0], (Reference(object()),), ())
    with pytest.raises(NotStorable, match="a term holds a Python object"):
        stored(host.agent)


def tampered(pickled: bytes) -> Mind:
    host = mind("")
    data = {"format": stored(host.agent)["format"], "mind": base64.b64encode(pickled).decode()}
    restore(host.agent, data)
    return host.agent


@pytest.mark.parametrize("called", [os.system, eval, type(nodes.Node), new_engine], ids=repr)
def test_data_that_calls_something_else_is_refused(called):
    with pytest.raises(ValueError, match="is not part of a mind"):
        tampered(pickle.dumps(called))


class Changed:
    def __reduce__(self) -> tuple[object, ...]:
        return atom, ("true",), {"name": "false"}


def test_a_deep_stack_and_a_long_open_list_are_stored():
    host = mind("""
        !deep. !open.
        +!deep <- !count(10000, R); .print(R).
        +!count(0, 0) <- .wait(1000). +!count(N, R) <- !count(N-1, Q); R = Q + 1.
        +!open <- !build(2000, L, T); .copy_term(L, C); .wait(2000); T = []; C = [_|_]; .length(L, N); .print(N).
        +!build(0, T, T). +!build(N, [N|L], T) <- !build(N-1, L, T).
        """)
    host.agent.run(100_000)
    restored(host)
    host.run()
    assert (host.printed, host.logged) == (["10000", "2000"], [])
