"""Observations as percepts."""

from jacaros.agents.body.values import PerceptWriter, References
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Reference, atom, structure
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.property import ObservableProperty, Observation, Signal
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.trace import Cause

LAMP = ArtifactId("Lamp", "Lamp", "/main/lab", 1, None)
MAIN = object()


def writer() -> PerceptWriter:
    return PerceptWriter(References(), lambda path: MAIN)


def observable(name: str, *values: object, annotations: tuple[object, ...] = ()) -> ObservableProperty:
    return ObservableProperty(name, values, annotations, 1)


def lines(observation: Observation, namespace: str | None = None) -> list[str]:
    return [f"{p.kind} {text(p.literal)}" for p in writer().percepts(observation, namespace)]


def test_signals_come_first_then_changes_additions_and_removals():
    observation = Observation(
        LAMP,
        signals=(Signal("tick", (1,)), Signal("tock", ())),
        changed=((observable("power", 1), observable("power", 2)),),
        added=(observable("on"),),
        removed=(observable("off"),),
    )
    assert lines(observation) == [
        "signal tick(1)", "signal tock", "remove power(1)", "add power(2)", "add on", "remove off"
    ]  # fmt: skip


def test_annotations_name_the_source_in_order_and_those_of_the_property():
    signal, added = writer().percepts(Observation(LAMP, (Signal("tick", ()),), added=(observable("on"),)))
    names = [a[0].name for a in added.annotations]
    assert names == ["artifact_id", "artifact_name", "percept_type", "source", "workspace"]
    assert added.annotations == annotation_set(added.annotations)
    by_name = {a[0].name: a[1:] for a in added.annotations}
    assert by_name["artifact_id"] == (Reference(LAMP),)
    assert by_name["artifact_name"] == (atom("'Lamp'"),)
    assert by_name["percept_type"] == (atom("obs_prop"),)
    assert by_name["workspace"] == ("/main/lab", Reference(MAIN))
    assert structure("percept_type", atom("obs_ev")) in signal.annotations
    marked = observable("on", annotations=(Structure("unit", (Atom("volt"),)), Atom("a")))
    (percept,) = writer().percepts(Observation(LAMP, added=(marked,)))
    assert atom("a") in percept.annotations
    assert structure("unit", atom("volt")) in percept.annotations
    assert percept.annotations == annotation_set(percept.annotations)
    signal_of = Observation(LAMP, (Signal("click", ()),), added=(observable("on"),))
    for percept in writer().percepts(signal_of):
        assert percept.annotations == annotation_set(percept.annotations)


def test_a_percept_has_one_reference_and_its_cause():
    write = writer()
    first, second = [
        write.percepts(Observation(LAMP, added=(observable("on", i),)))[0].annotations for i in (1, 2)
    ]
    assert first is second
    why = Cause(1, 0, "sample", "odom")
    assert writer().percepts(Observation(LAMP, added=(observable("on"),), cause=why))[0].cause is why


def test_missing_large_and_namespaced_values():
    assert lines(Observation(LAMP, added=(observable("on", 1),)), "lab") == ["add lab::on(1)"]
    assert lines(Observation(LAMP, added=(observable("pose", None, [1, None]),))) == [
        "add pose(null,[1,null])"
    ]
    assert lines(Observation(LAMP, added=(observable("n", 10**400, -(10**400)),))) == [
        "add n(Infinity,-Infinity)"
    ]


def test_percepts_about_the_agent_are_like_properties_of_an_artifact():
    session = ArtifactId("session_bob", "AgentSessionArtifact", "/main", 9, None)
    percept = writer().own("add", session, "joinedWsp", Reference(MAIN), atom("main"))
    assert [text(a).partition("(")[0] for a in percept.annotations] == [
        "artifact_id",
        "artifact_name",
        "percept_type",
        "source",
        "workspace",
    ]
    assert "artifact_name(session_bob)" in [text(a) for a in percept.annotations]


def test_what_is_written_of_a_property_is_the_same_for_all_and_at_its_end():
    one, two, write = observable("power", 1, "mains"), observable("power", 2.5, Atom("off")), writer()
    change = Observation(LAMP, changed=((one, two),))
    first = write.percepts(change)
    assert write.percepts(change) is first
    (end,) = write.percepts(Observation(LAMP, removed=(two,)))
    assert end.literal is first[1].literal
    assert end.annotations is first[1].annotations
    assert [text(p.literal) for p in write.percepts(change, "lamps")] == [
        'lamps::power(1,"mains")',
        "lamps::power(2.5,off)",
    ]
    assert [text(p.literal) for p in write.percepts(change)] == ['power(1,"mains")', "power(2.5,off)"]
