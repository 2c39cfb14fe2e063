"""Urgency."""

from collections import Counter, deque
from pathlib import Path
from random import Random

import pytest
from recording_host import RecordingHost, mind, printed, programs

from jacaros.agents.mind.rules import urgency
from jacaros.agents.mind.rules.urgency import Fair, Urgent, UrgentQueue
from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.intention import Event
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.values import SOURCE_PERCEPT, Term, Var, atom, structure
from jacaros.testing import RunResult, run_project

TWO_STEPS = """
    +low(I) <- .print("low ", I); .print("end of low ", I).
    @stop[urgency(10)] +bump(I) <- .print("bump ", I); .print("end of bump ", I).
"""


def noticed(*literals: Term) -> list[Percept]:
    annotations = annotation_set((SOURCE_PERCEPT,))
    return [Percept("add", literal, annotations) for literal in literals]


def low(number: int) -> Term:
    return structure("low", float(number))


def bump(number: int) -> Term:
    return structure("bump", float(number))


def told(*literals: Term, program: str = TWO_STEPS, options: Options | None = None) -> RecordingHost:
    host = mind(program, options=options)
    host.agent.perceive(noticed(*literals))
    host.run()
    return host


# --- events ---------------------------------------------------------------------------------------------------


def test_an_urgent_event_comes_first_and_equals_in_order():
    assert told(low(1), low(2), bump(1)).printed == [
        *("bump 1", "end of bump 1"),
        *("low 1", "end of low 1", "low 2", "end of low 2"),
    ]
    program = TWO_STEPS.replace("[urgency(10)]", "")
    assert told(low(1), low(2), bump(1), program=program).printed == [
        *("low 1", "end of low 1", "low 2", "bump 1", "end of low 2", "end of bump 1")
    ]
    program = TWO_STEPS + '@other[urgency(10)] +edge(I) <- .print("edge ", I); .print("end of edge ", I).'
    edge = structure("edge", 1.0)
    assert told(low(1), bump(1), edge, bump(2), program=program).printed == [
        *("bump 1", "end of bump 1", "edge 1", "bump 2", "end of edge 1", "end of bump 2"),
        *("low 1", "end of low 1"),
    ]
    program = """
        +a <- .print(a). @b[urgency(1)] +b <- .print(b). @c[urgency(2)] +c <- .print(c). @d[urgency(3)] +d <- .print(d).
    """
    literals = [atom(name) for name in "abcdbcad"]
    assert told(*literals, program=program).printed == ["d", "d", "c", "c", "b", "b", "a", "a"]


def test_an_event_is_as_urgent_as_its_most_urgent_plan():
    program = TWO_STEPS + '@never[urgency(20)] +low(I) : I > 100 <- .print("high ", I).'
    assert told(bump(1), low(1), program=program).printed[0] == "low 1"
    program = TWO_STEPS + "@all[urgency(10)] +Any : false <- true."
    assert told(low(1), bump(1), program=program).printed[0] == "low 1"
    program = TWO_STEPS.replace("urgency(10)", "urgency(high), urgency(1.5), urgency(-3), urgency")
    assert told(low(1), bump(1), program=program).printed[0] == "low 1"


# --- intentions -----------------------------------------------------------------------------------------------


def test_the_goals_of_an_urgent_plan_are_as_urgent():
    program = (
        TWO_STEPS
        + """
        @worse[urgency(20)] +crash <- !halt; .print(reported).
        +!halt <- .print(brake); .print(off).
    """
    )
    assert told(low(1), bump(1), atom("crash"), program=program).printed[:3] == ["brake", "off", "reported"]


PROGRAMS = """
an urgent goal lifts its intention while it is pursued => a1 | h1 | h2 | h3 | b1 | a2 | b2 | a3 | b3 | b4 | b5
    !a. !b.
    +!a <- .print(a1); !hurry; .print(a2); .print(a3).
    +!b <- .print(b1); .print(b2); .print(b3); .print(b4); .print(b5).
    @now[urgency(5)] +!hurry <- .print(h1); .print(h2); .print(h3).
an urgent handler of a failure goes first => a1 | saved | safe | b1 | b2 | b3
    !a. !b.
    +!a <- .print(a1); .fail.
    +!b <- .print(b1); .print(b2); .print(b3).
    @save[urgency(1)] -!a <- .print(saved); .print(safe).
intentions of equal urgency take turns => a1 | a2 | b1 | a3 | b2 | b3 | w1 | w2
    !work. !a. !b.
    @a[urgency(1)] +!a <- .print(a1); .print(a2); .print(a3).
    @b[urgency(1)] +!b <- .print(b1); .print(b2); .print(b3).
    +!work <- .print(w1); .print(w2).
a suspended urgent intention blocks no others and goes first when resumed => a1 | b1 | b2 | a2 | a3 | b3 | b4
    !a. !b.
    @a[urgency(1)] +!a <- .print(a1); .suspend; .print(a2); .print(a3).
    +!b <- .print(b1); .print(b2); .resume(a); .print(b3); .print(b4).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


def test_no_event_is_handled_while_a_more_urgent_intention_is_ready():
    program = """
        +low(I) : .count(busy, 0) <- .print("low ", I).
        +low(I) <- .print("bad moment ", I).
        @stop[urgency(10)] +bump(I) <- +busy; .print("bump ", I); -busy.
    """
    assert told(low(1), low(2), bump(1), program=program).printed == ["bump 1", "low 1", "low 2"]


def test_intentions_that_wait_let_others_continue_and_atomic_ones_are_not_interrupted():
    program = """
        !a. !b.
        @a[urgency(1)] +!a <- .print(a1); .wait(10); .print(a2); .print(a3).
        +!b <- for (.range(I, 1, 3)) { .print(b, I); .wait(8); .print(c, I) }.
    """
    lines = printed(program)
    assert lines[:2] == ["a1", "b1"]
    assert lines.index("a3") == lines.index("a2") + 1
    program = (
        TWO_STEPS
        + """
        @pay[atomic] +!pay <- .print(p1); ++bump(1); .print(p2); !more; .print(p3).
        +!more <- .print(m1).
        !pay.
    """
    )
    assert printed(program) == ["p1", "p2", "m1", "p3", "bump 1", "end of bump 1"]


def test_a_deep_stack_knows_its_urgency():
    program = """
        !down(2000). !other.
        +!down(0) <- .print(bottom).
        +!down(N) <- !down(N - 1); true.
        +!other <- .print(o1); .print(o2).
        @now[urgency(1)] +bump(I) <- .print("bump ", I).
    """
    host = mind(program)
    host.agent.run(500)
    host.agent.perceive(noticed(bump(1)))
    host.run()
    assert host.printed == ["o1", "o2", "bump 1", "bottom"]


# --- plans and options ----------------------------------------------------------------------------------------


def test_plans_that_become_urgent_count_from_the_next_cycle():
    program = """
        +low(I) <- .print("low ", I); .print("end of low ", I).
        !start.
        +!start
          <- ++low(1); ++low(2);
             .add_plan("@stop[urgency(10)] +bump(I) <- .print(bump(I)); .print(end(I)).");
             ++bump(1); ++low(3); .print(started).
    """
    lines = printed(program)
    assert lines.index("bump(1)") + 1 == lines.index("end(1)")
    assert lines.index("end(1)") < lines.index("started")
    assert [line for line in lines if line.startswith("low")] == ["low 1", "low 2", "low 3"]
    program = """
        +low(I) <- .print("low ", I).
        @old +bump(I) : false.
        !start.
        +!start
          <- .add_plan("@stop[urgency(10)] +bump(I) <- .print(bump(I)).", self, begin).
    """
    host = mind(program)
    host.agent.perceive(noticed(low(1), low(2), low(3), bump(1)))
    host.run()
    assert host.printed == ["bump(1)", "low 1", "low 2", "low 3"]
    program = TWO_STEPS + '+bump(I) <- .print("bump as well").'
    host = mind(program + "!s. +!s <- .remove_plan(stop).")
    host.run()
    host.agent.perceive(noticed(low(1), bump(1)))
    host.run()
    assert host.printed == ["low 1", "end of low 1", "bump as well"]


def test_an_option_sets_the_urgency_of_events_and_takes_precedence():
    program = TWO_STEPS.replace("[urgency(10)]", "")
    options = Options(urgency=(("bump", 3),))
    host = told(low(1), low(2), bump(1), program=program, options=options)
    assert host.printed[:2] == ["bump 1", "end of bump 1"]
    options = Options(urgency=(("bump", 0), ("low", 1)))
    assert told(bump(1), low(1), options=options).printed[0] == "low 1"


def test_sub_plans_count_for_the_urgency_of_events():
    program = """
        !guard.
        +!guard <- .wait(1000) { @stop[urgency(9)] +bump(I) <- .print("bump ", I); .print("end of bump ", I). }.
        +low(I) <- .print("low ", I); .print("end of low ", I).
    """
    host = mind(program)
    host.run(seconds=0.0)
    host.agent.perceive(noticed(low(1), bump(1)))
    host.run(seconds=0.0)
    assert host.printed[:2] == ["bump 1", "end of bump 1"]


def test_an_agent_without_urgent_plans_is_fair():
    host = mind("!s. +!s <- .print(a).")
    host.run()
    assert isinstance(host.agent.selections, Fair)
    assert host.agent.events.__class__ is deque


# --- bursts ---------------------------------------------------------------------------------------------------


def test_a_burst_of_percepts_does_not_keep_an_urgent_goal_waiting():
    program = """
        +low(I) <- ++handled(I).
        @stop[urgency(10)] +bump(I) <- .print(brake); .print(off); .count(handled(_), N); .print(N).
    """
    host = mind(program)
    host.run()
    host.agent.perceive(noticed(*map(low, range(10_000)), bump(1)))
    before = host.agent.counts.cycles
    host.agent.run(4)
    assert host.agent.counts.cycles - before == 4
    assert host.printed == ["brake", "off", "0"]
    host.run()
    assert len(host.agent.beliefs[structure("handled", 1.0)[0]]) == 10_000


def test_a_stream_of_percepts_does_not_keep_an_urgent_goal_waiting():
    program = """
        +low(I) <- .print("low").
        @stop[urgency(1)] +!stop(0) <- .print(stopped).
        @down[urgency(1)] +!stop(N) <- !stop(N - 1).
        @bump +bump(I) <- !stop(20).
    """
    host = mind(program, options=Options(urgency=(("bump", 1),)))
    host.run()
    host.agent.perceive(noticed(bump(1)))
    for turn in range(22):
        host.agent.perceive(noticed(*map(low, range(turn * 100, turn * 100 + 100))))
        host.agent.run(1)
    assert host.printed == ["stopped"]


def test_a_burst_is_not_sorted_when_something_urgent_comes(monkeypatch):
    asked = []
    of_event = Urgent._of_event

    def counted(selections: Urgent, event: Event) -> int:
        asked.append(event)
        return of_event(selections, event)

    monkeypatch.setattr(Urgent, "_of_event", counted)
    host = mind("+low(I) <- true. @stop[urgency(10)] +bump(I) <- .print(bump(I)); .print(off).")
    host.run()
    host.agent.perceive(noticed(*map(low, range(10_000))))
    host.agent.run(1)
    for number in range(3):
        asked.clear()
        host.agent.perceive(noticed(bump(number)))
        host.agent.run(4)
        assert host.printed[-2:] == [f"bump({number})", "off"]
        assert len(asked) < 50
    assert len(host.agent.events) > 9_900


@pytest.mark.parametrize("events", ["discard", "requeue"])
def test_the_queues_are_in_order_in_every_cycle(events):
    """As long as nothing urgent was noted, all that waits has urgency 0: so nothing has to be sorted.

    But for events that are put back to be tried again: they go back to the front.
    """
    program = """
        +low(I) <- !calm(I); .wait({ +tick }, 20); !!calm(I).
        +!calm(I) <- .print(I); ++noted(I); true.
        +!fork(I) <- (!calm(I) |&| !hurry(I) ||| .wait(5)); !calm(I).
        @hurry[urgency(3)] +!hurry(I) : I mod 3 > 0 <- .wait(I mod 7); -+hurried(I); .fail_goal(calm(I)).
        -!hurry(I) <- .suspend(calm(_)); .wait(3); .resume(calm(_)).
        @bump[urgency(10)] +bump(I) : I mod 4 > 0 <- !!fork(I); !hurry(I).
        @noted[urgency(1)] +noted(I) : I mod 5 = 0 <- .drop_desire(calm(I + 1)); true.
    """
    host = mind(program, options=Options(events=events))
    agent, chance = host.agent, Random(18)
    ranked = Counter[bool]()
    for number in range(1500):
        if chance.random() < 0.2:
            kinds = chance.choices([low, bump, lambda _: atom("tick")], [6, 1, 2], k=chance.randrange(1, 6))
            agent.perceive(noticed(*(kind(number) for kind in kinds)))
        agent.run(1)
        if chance.random() < 0.1:
            host.ring_next(host.time + 1000)
        selections = agent.selections
        assert isinstance(selections, Urgent)
        of_events = [selections._of_event(event) for event in agent.events]
        of_intentions = [selections.urgency_of(each) for each in agent.intentions if not each.dropped]
        for urgencies in (of_events, of_intentions):
            assert urgencies == sorted(urgencies, reverse=True)
            assert events == "requeue" or not (selections.plain and any(urgencies))
        ranked[selections.plain] += 1
    assert min(ranked[True], ranked[False]) > 100


# --- the queue ------------------------------------------------------------------------------------------------


def test_a_queue_in_order_of_urgency():
    queue: UrgentQueue[tuple[int, str]] = UrgentQueue(lambda item: item[0])
    for item in ((0, "a"), (5, "b"), (0, "c"), (5, "d"), (9, "e"), (3, "f"), (0, "g"), (3, "h")):
        queue.append(item)
    assert "".join(name for _, name in queue) == "ebdfhacg"
    queue.extendleft([(3, "i"), (0, "j"), (9, "k")])
    assert "".join(name for _, name in queue) == "kebdifhjacg"
    assert queue.popleft() == (9, "k")


# --- busy agents ----------------------------------------------------------------------------------------------

BUSY = """
    !start.
    +!start <- for (.range(I, 1, 100)) { !!work(I) }.
    +!work(I) <- +busy(I); -busy(I); !work(I).
    @stop[urgency(10)] +bump(I) <- !halt(I).
    +!halt(I) <- .print("halt ", I).
"""


def busy(program: str = BUSY) -> RecordingHost:
    host = mind(program)
    host.agent.run(20000)
    assert len(host.agent.alive) >= 100
    return host


def test_urgent_percepts_messages_and_waits_go_first_beside_a_hundred_busy_intentions():
    host = busy()
    host.agent.perceive(noticed(bump(1)))
    host.agent.run(2)
    assert host.printed == ["halt 1"]
    host = busy(BUSY + "@ask[urgency(5)] +!stop <- .print(stopped).")
    host.agent.receive(SpeechAct("achieve", "bob", "tester", atom("stop"), "m1"))
    host.agent.run(1)
    assert host.printed == ["stopped"]
    host = busy(BUSY + "@w[urgency(5)] +go <- .wait(10); .print(first); .wait(10); .print(second).")
    host.agent.perceive(noticed(atom("go")))
    for expected in ([], ["first"], ["first", "second"]):
        host.agent.run(5)
        assert host.printed == expected
        host.ring_next(host.time + 1000)


def test_urgent_questions_and_goals_of_messages_go_first():
    host = mind("+low(I) <- .print(low, I). @q[urgency(5)] +?state(X) <- .print(asked); X = ok.")
    host.agent.perceive(noticed(*(low(number) for number in range(5))))
    host.agent.receive(SpeechAct("askOne", "bob", "tester", structure("state", Var()), "m1"))
    host.run()
    assert host.printed[0] == "asked"
    program = '@halt[urgency(2)] +!halt <- .print(halted). +low(I) <- .print("low ", I); true.'
    host = mind(program)
    for number in range(1, 4):
        host.agent.receive(SpeechAct("tell", "friend", "tester", low(number), f"m{number}"))
    host.agent.receive(SpeechAct("achieve", "friend", "tester", atom("halt"), "m9"))
    host.run()
    assert host.printed == ["halted", "low 1", "low 2", "low 3"]
    host = mind(TWO_STEPS.replace('.print("end of low ", I)', "true"))
    for number in range(1, 101):
        host.agent.receive(SpeechAct("tell", "friend", "tester", low(number), f"m{number}"))
    host.agent.receive(SpeechAct("tell", "friend", "tester", bump(1), "m101"))
    host.agent.receive(SpeechAct("tell", "friend", "tester", low(101), "m102"))
    host.agent.run(2)
    assert host.printed == ["bump 1", "end of bump 1"]
    assert len(host.agent.incoming.messages) == 0
    host.run()
    assert host.printed[2:] == [f"low {number}" for number in range(1, 102)]


def test_the_first_goes_first_while_nothing_is_urgent():
    host = busy()
    agent = host.agent
    assert agent.selections.plain
    agent.perceive(noticed(bump(1)))
    agent.run(1)
    assert not agent.selections.plain
    agent.run(100)
    assert host.printed == ["halt 1"]
    assert agent.selections.plain


CASES = Path(__file__).parents[3] / "conformance"
PROGRAMS = sorted(
    path
    for area in ("concurrency", "failure", "intentions", "messages", "plan_selection", "programs")
    for pattern in ("*.asl", "*/*.mas2j")
    for path in (CASES / area).glob(pattern)
)


def test_there_are_programs():
    assert len(PROGRAMS) > 50


@pytest.mark.parametrize("ordered", [False, True], ids=["plain", "in order of urgency"])
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_program_prints_the_same(program, ordered, monkeypatch):
    ordered_agents = []

    def run() -> RunResult:
        return run_project(
            program,
            seconds=120,
            when_started=lambda mas: ordered_agents.extend(
                isinstance(host.mind.selections, urgency.Urgent) for host in mas.directory
            ),
        )

    plain = run()
    assert not any(ordered_agents)
    monkeypatch.setattr(urgency, "has_urgent_plans", lambda agent: True)
    if ordered:
        monkeypatch.setattr(urgency.Urgent, "_calm_down", lambda selections: None)
    ordered_agents.clear()
    urgent = run()
    assert all(ordered_agents)
    assert (urgent.lines, urgent.errors, urgent.exit_code) == (plain.lines, plain.errors, plain.exit_code)
