"""Goals that are dropped, suspended, ended and failed at any moment, in every place an intention can be."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_host import RecordingHost, mind

from jacaros.agents.language.loader import load_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.mind import Mind, new_engine
from jacaros.agents.mind.rules import goals
from jacaros.agents.mind.rules.belief_update import tell
from jacaros.agents.mind.state.act import Completion
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Term, Var, structure

PROGRAM = """
+!task(N,K) <- .print(N, " begins"); !sub(N,K); .print(N, " ends").
-!task(N,K) : K mod 2 = 0 <- .print(N).

+!sub(N,0) <- act(N); .print(N).
+!sub(N,1) <- .wait(10); .print(N); .wait(10); .print(N).
+!sub(N,2) <- (act(N); .print(N)) |&| (.wait(5); .print(N)) |&| !sub(N,0).
+!sub(N,3) <- .wait(flag(N), 50); .print(N).
+!sub(N,4) <- .wait({+go(N)}, 70); .print(N).
+!sub(N,5) <- (act(N); .print(N)) ||| (.wait(20); .print(N)) ||| !sub(N,1).
@quiet[atomic] +!sub(N,6) <- .print(N); act(N); .print(N).
+!sub(N,7) <- +b(N); .print(N); -b(N).
+!sub(N,8) <- for (.range(I,1,3)) { !sub(N,I); .print(N) }.
+!sub(N,9) <- !missing(N).
+!sub(N,10) <- ?asked(N); .print(N).
-!sub(N,K) : K > 3 <- act(N); .print(N).
+?asked(N) <- .wait(3); .print(N).
+b(N) <- .print(N); act(N).
-b(N) <- .wait(1); .print(N).
"""
TREE = load_program("tester.asl", PROGRAM)[0]
PLANS = ProgramPlans(TREE.plans, new_engine(STANDARD))  # compiled once for all examples
KINDS = 11
numbers = st.integers(0, 3).map(float)
runs = st.tuples(st.just("run"), st.integers(1, 6))
tasks = st.tuples(st.just("task"), st.integers(0, KINDS - 1).map(float))
steps = st.one_of(
    tasks,
    runs,
    runs,
    runs,
    st.tuples(st.just("ring"), st.just(0)),
    st.tuples(st.just("complete"), st.integers(0, 9), st.booleans()),
    st.tuples(st.just("believe"), st.sampled_from(["flag", "go"]), numbers),
    st.tuples(
        st.sampled_from(["drop", "drop event", "suspend", "resume", "succeed", "fail"]),
        st.sampled_from(["task", "sub"]),
        numbers,
    ),
)


stories = st.tuples(st.lists(tasks, min_size=1, max_size=4), st.lists(steps, min_size=5, max_size=50)).map(
    lambda parts: [*parts[0], *parts[1]]
)


class Storm:
    """An agent to which things happen, and what must be true of it all the time."""

    def __init__(self) -> None:
        self.host = RecordingHost()
        self.host.agent = self.agent = Mind("tester", TREE, self.host, plans=PLANS)
        self.completed: list[int] = []
        self.still: set[float] = set()
        self.failed: set[float] = set()  # their failure events cannot be dropped as goals
        self.tasks = 0

    def under_way(self) -> list[int]:
        """External actions that have neither ended nor been cancelled."""
        over = {*self.completed, *self.host.cancelled}
        return [act.id for act in self.host.acts if act.id not in over]

    def step(self, step: tuple[Any, ...]) -> None:
        """Let one thing happen."""
        kind = step[0]
        if kind == "task":
            self.tasks += 1
            self.agent.post_goal(structure("task", float(self.tasks), step[1]))
        elif kind == "run":
            self.run(step[1])
        elif kind == "ring":
            self.host.ring_next(self.host.time + 1000)
        elif kind == "complete":
            self.complete(step[1], step[2])
        elif kind == "believe":
            tell(self.agent, structure(step[1], self.number(step[2])))
        else:
            self.control(kind, step[1], self.number(step[2]))
        self.check()

    def number(self, index: float) -> float:
        """One of the last tasks."""
        return max(1.0, self.tasks - index)

    def run(self, cycles: int) -> None:
        """Some cycles; what stands still does nothing."""
        before = len(self.host.printed)
        self.agent.run(cycles)
        assert not {float(line.split()[0]) for line in self.host.printed[before:]} & self.still

    def complete(self, index: int, success: bool) -> None:
        """End an action; a second end of the same one is of no account."""
        pending = self.under_way()
        if pending:
            act = pending[index % len(pending)]
            self.completed.append(act)
            self.agent.complete(act, Completion(success))
            self.agent.complete(act, Completion(not success))

    def control(self, what: str, name: str, number: float) -> None:
        """Steer the goals of a number from outside."""
        goal: Term = structure(name, number, Var())
        whole = name == "task"
        if what == "drop":
            goals.drop_desire(self.agent, goal)
            if whole and number not in self.failed:
                self.still.add(number)
        elif what == "drop event":
            goals.drop_events(self.agent, goal)
        elif what == "suspend":
            goals.suspend_goal(self.agent, goal)
            if whole and number not in self.failed:
                self.still.add(number)
        else:
            if what == "resume":
                goals.resume_goal(self.agent, goal)
            elif what == "succeed":
                goals.succeed_goal(self.agent, goal)
            else:
                goals.fail_goal(self.agent, goal)
                self.failed.add(number)
            self.still.discard(number)

    def check(self) -> None:
        """Every action that has begun is pending, has ended or was cancelled, and only one of them."""
        ended = [*self.completed, *self.host.cancelled]
        assert len(ended) == len(set(ended))
        assert sorted(self.agent.waits.acts) == sorted(self.under_way())
        agent = self.agent
        waits = [*agent.waits.acts.values(), *(each.arguments[0] for each in agent.waits.conditions.values())]
        waits += [each.arguments[0] for held in agent.waits.events.values() for each in held.values()]
        assert not any(waiting.intention.dropped for waiting in waits)
        ready = [intention for intention in agent.intentions if not intention.dropped]
        assert len(ready) == len(set(ready))
        assert all(intention.id in agent.alive for intention in ready)
        for news in ("begins", "ends"):
            told = [line for line in self.host.printed if line.endswith(news)]
            assert len(told) == len(set(told))

    def calm_down(self) -> None:
        """Let everything end."""
        for _ in range(500):
            self.still.clear()
            for name in ("task", "sub"):
                goals.resume_goal(self.agent, structure(name, Var(), Var()))
            while self.agent.run(100):
                self.check()
            if self.under_way():
                self.complete(0, True)
            elif not self.host.ring_next(self.host.time + 1000):
                return


def emptiness(storm: Storm) -> dict[str, object]:
    """All places where something of an intention could be left."""
    agent = storm.agent
    return {
        "alive": [(i, [text_of(frame) for frame in i.frames]) for i in agent.alive.values()],
        "intentions": [i for i in agent.intentions if not i.dropped],
        "events": list(agent.events),
        "suspended events": agent.waits.suspended_events,
        "acts": agent.waits.acts,
        "event waits": agent.waits.events,
        "condition waits": agent.waits.conditions,
        "tasks": list(agent.incoming.tasks),
        "atomic": agent.atomic,
        "trail": list(agent.trail),
    }


def text_of(frame: Any) -> str:
    return f"{frame[1][0]!r} {[text(argument) for argument in frame[1][1:]]}"


@settings(max_examples=100)
@given(stories)
def test_ended_goals_leave_nothing_behind_however_they_ended(story):
    storm = Storm()
    for step in story:
        storm.step(step)
    storm.calm_down()
    assert not any(emptiness(storm).values()), emptiness(storm)
    assert not [line for level, line in storm.host.logged if level == "error"]


@settings(max_examples=60)
@given(stories)
def test_nothing_runs_after_everything_is_dropped(story):
    storm = Storm()
    for step in story:
        storm.step(step)
    goals.drop_all_events(storm.agent)
    goals.drop_all_intentions(storm.agent)
    printed, acts = len(storm.host.printed), len(storm.host.acts)
    storm.agent.incoming.tasks.clear()
    while storm.agent.run(100) or storm.host.ring_next(storm.host.time + 1000):
        storm.check()
    assert not storm.under_way()
    assert (len(storm.host.printed), len(storm.host.acts)) == (printed, acts)
    assert not any(emptiness(storm).values()), emptiness(storm)


@settings(max_examples=80)
@given(
    st.lists(st.tuples(numbers, st.sampled_from([1.0, 4.0, 6.0, 7.0])), min_size=1, max_size=5),
    st.lists(st.booleans(), max_size=12),
)
def test_nothing_else_runs_between_the_steps_of_an_atomic_plan(tasks, ends):
    host = mind(
        """
        @calm[atomic] +!sub(N,6) <- .print(begin); act(N); !inner(N); .print(end).
        +!inner(N) <- .print(inside); +c(N); .print(inside).
        +c(N) <- .print(inside).
        +!task(N,K) <- .print(N); !sub(N,K); .print(N).
        +!sub(N,K) <- .print(N); .wait(1); act(N); .print(N).
        -!sub(N,K) <- .print(failed).
        """
    )
    for number, kind in tasks:
        host.agent.post_goal(structure("task", number, kind))
    ended = iter(ends)
    done = 0
    while host.agent.run(3) or done < len(host.acts) or host.ring_next(host.time + 1000):
        if done < len(host.acts):
            host.agent.complete(host.acts[done].id, Completion(next(ended, True)))
            done += 1
    inside = False
    for line in host.printed:
        if line == "begin":
            assert not inside
        if inside:
            assert line in ("inside", "end", "failed")
        inside = line == "begin" or (inside and line not in ("end", "failed"))
    assert not inside


@pytest.mark.parametrize("seed", range(3))
def test_an_id_that_is_not_pending_is_ignored(seed):
    host = mind("!g. +!g <- act(1); .print(done).")
    host.run()
    host.agent.complete(99 + seed, Completion(False))
    host.run()
    assert host.printed == []
