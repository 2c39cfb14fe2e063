"""Percepts: beliefs with source(percept), and the events of their coming and going."""

from recording_host import RecordingHost, believed, mind

from jacaros.bdi.act import Percept
from jacaros.terms.order import annotation_set
from jacaros.terms.values import SOURCE_PERCEPT, Term, atom, structure


def percept(kind: str, value: float, artifact: str = "a") -> Percept:
    annotations = annotation_set((SOURCE_PERCEPT, structure("artifact_name", atom(artifact))))
    return Percept(kind, structure("level", value), annotations)


def told(*changes: Percept, program: str = "") -> RecordingHost:
    host = mind("+level(X) <- .print(plus(X)). -level(X) <- .print(minus(X))." + program)
    host.agent.perceive(list(changes))
    host.run()
    return host


def test_a_percept_becomes_a_belief_and_an_event() -> None:
    host = told(percept("add", 1.0))
    assert host.printed == ["plus(1)"]
    assert believed(host, "level") == ["level(1)[artifact_name(a),source(percept)]"]


def test_all_plans_of_a_change_see_the_newest_beliefs() -> None:
    host = mind("-level(X) <- ?level(Y); .print(minus(X, Y)). +level(X) <- .print(plus(X)).")
    host.agent.perceive([percept("add", 1.0)])
    host.run()
    host.agent.perceive([percept("remove", 1.0), percept("add", 2.0)])
    host.run()
    assert host.printed == ["plus(1)", "minus(1,2)", "plus(2)"]


def test_a_signal_is_an_event_and_no_belief() -> None:
    host = told(percept("signal", 5.0))
    assert host.printed == ["plus(5)"]
    assert believed(host, "level") == []


def test_one_literal_seen_twice_stays_while_one_of_them_holds() -> None:
    host = told(percept("add", 1.0, "a"), percept("add", 1.0, "b"), percept("remove", 1.0, "a"))
    assert believed(host, "level") == ["level(1)[artifact_name(b),source(percept)]"]


def test_an_own_belief_beside_a_percept_outlives_it() -> None:
    host = told(percept("add", 1.0), program="!s. +!s <- +level(1).")
    host.agent.perceive([percept("remove", 1.0)])
    host.run()
    assert believed(host, "level") == ["level(1)[source(self)]"]


def test_the_agent_cannot_delete_a_percept_as_its_own() -> None:
    host = told(percept("add", 1.0), program="+!s <- -level(1).")
    goal: Term = atom("s")
    host.agent.post_goal(goal)
    host.run()
    assert believed(host, "level") == ["level(1)[artifact_name(a),source(percept)]"]
