"""Percepts: beliefs with source(percept), and the events of their coming and going."""

from recording_host import RecordingHost, believed, mind

from jacaros.agents.mind.state.act import Percept
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.values import SOURCE_PERCEPT, String, Term, atom, make_list, structure


def percept(kind: str, value: float, artifact: str = "a") -> Percept:
    annotations = annotation_set((SOURCE_PERCEPT, structure("artifact_name", atom(artifact))))
    return Percept(kind, structure("level", value), annotations)


def told(*changes: Percept, program: str = "") -> RecordingHost:
    host = mind("+level(X) <- .print(plus(X)). -level(X) <- .print(minus(X))." + program)
    host.agent.perceive(list(changes))
    host.run()
    return host


def test_percepts_and_signals_are_events_and_only_percepts_beliefs():
    host = told(percept("add", 1.0))
    assert host.printed == ["plus(1)"]
    assert believed(host, "level") == ["level(1)[artifact_name(a),source(percept)]"]
    host = told(percept("signal", 5.0))
    assert host.printed == ["plus(5)"]
    assert believed(host, "level") == []
    host = mind("-level(X) <- ?level(Y); .print(minus(X, Y)). +level(X) <- .print(plus(X)).")
    host.agent.perceive([percept("add", 1.0)])
    host.run()
    host.agent.perceive([percept("remove", 1.0), percept("add", 2.0)])
    host.run()
    assert host.printed == ["plus(1)", "minus(1,2)", "plus(2)"]


def test_a_belief_stays_while_a_percept_or_the_agent_holds_it():
    host = told(percept("add", 1.0, "a"), percept("add", 1.0, "b"), percept("remove", 1.0, "a"))
    assert believed(host, "level") == ["level(1)[artifact_name(b),source(percept)]"]
    host = told(percept("add", 1.0), program="!s. +!s <- +level(1).")
    host.agent.perceive([percept("remove", 1.0)])
    host.run()
    assert believed(host, "level") == ["level(1)[source(self)]"]
    host = told(percept("add", 1.0), program="+!s <- -level(1).")
    goal: Term = atom("s")
    host.agent.post_goal(goal)
    host.run()
    assert believed(host, "level") == ["level(1)[artifact_name(a),source(percept)]"]
    twice = percept("add", 1.0)
    host = told(twice, twice, Percept("remove", twice.literal, twice.annotations))
    assert believed(host, "level") == ["level(1)[artifact_name(a),source(percept)]"]
    host.agent.perceive([Percept("remove", twice.literal, twice.annotations)])
    host.run()
    assert believed(host, "level") == []
    assert host.printed == ["plus(1)", "plus(1)", "minus(1)", "minus(1)"]


def test_percepts_of_any_arguments_come_and_go():
    host = mind("+shape(X) <- .print(plus(X)). -shape(X) <- .print(minus(X)).")
    values: list[Term] = [
        make_list([1.0, make_list([2.0])]),
        structure("point", 1.0, String("here")),
        atom("dot"),
    ]
    changes = [("add", value) for value in values] + [("remove", value) for value in values]
    annotations = annotation_set((SOURCE_PERCEPT,))
    for kind, value in changes:
        host.agent.perceive([Percept(kind, structure("shape", value), annotations)])
        host.run()
    assert host.printed == [
        *("plus([1,[2]])", 'plus(point(1,"here"))', "plus(dot)"),
        *("minus([1,[2]])", 'minus(point(1,"here"))', "minus(dot)"),
    ]
    assert believed(host, "shape") == []
    host = mind("+dark <- .print(dark). -dark <- .print(light).")
    for kind in ("add", "remove", "remove", "signal"):
        host.agent.perceive([Percept(kind, atom("dark"), annotation_set((SOURCE_PERCEPT,)))])
        host.run()
    assert host.printed == ["dark", "light", "dark"]
    assert believed(host, "dark") == []
    host = mind(
        """
        +!look(X) <- .findall(Y, at(X, Y), L); .print(X, L).
        !look(1).
        """
    )
    annotations = annotation_set((SOURCE_PERCEPT,))
    literals = [structure("at", float(n % 3), float(n)) for n in range(30)]
    host.agent.perceive([Percept("add", literal, annotations) for literal in literals])
    host.run()
    host.agent.perceive([Percept("remove", literal, annotations) for literal in literals[:-3]])
    host.agent.post_goal(structure("look", 1.0))
    host.run()
    assert host.printed[-1] == "1[28]"


def test_a_percept_that_the_agent_has_deleted_ends_without_an_event():
    host = told(percept("add", 1.0), program="!s. +!s <- .abolish(level(_)).")
    host.agent.perceive([percept("remove", 1.0)])
    host.run()
    assert host.printed == ["plus(1)", "minus(1)"]
    assert believed(host, "level") == []
