"""Values and observations as terms and percepts."""

import dataclasses
import math
from types import SimpleNamespace

import numpy
import pytest

from jacaros.agents.body.values import PerceptWriter, References, atom_of, to_term, to_value
from jacaros.agents.terms.collections import MapValue, SetValue
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    FALSE,
    NIL,
    TRUE,
    Annotated,
    Reference,
    String,
    Var,
    atom,
    functor,
    list_items,
    make_list,
    structure,
)
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.property import ObservableProperty, Observation, Signal
from jacaros.artifacts.env.values import Atom, Out, Structure
from jacaros.runtime.trace import Cause


def term(value: object) -> object:
    return to_term(value, References())


@pytest.mark.parametrize(
    ("number", "expected"), [(3.0, 3), (-4.0, -4), (0.5, 0.5), (3e9, 3_000_000_000), (1e20, 10**20)]
)
def test_a_whole_number_arrives_as_an_integer(number, expected):
    value = to_value(number)
    assert value == expected
    assert type(value) is type(expected)


def test_numbers_truth_values_and_strings_come_back():
    for value in (3, 3.0, -1, 10**20, 0.1):
        assert type(term(value)) is float
        assert term(value) == value
    assert term(10**400) == math.inf
    assert term(-(10**400)) == -math.inf
    assert to_value(math.inf) == math.inf
    assert math.isnan(to_value(math.nan))
    assert to_value(TRUE) is True
    assert to_value(FALSE) is False
    assert term(True) is TRUE
    assert term(False) is FALSE
    assert term(Atom("true")) is TRUE
    assert term(numpy.bool_(False)) is FALSE
    assert type(to_value(String("kitchen"))) is str
    assert to_value(atom("kitchen")) == Atom("kitchen")
    assert type(to_value(atom("kitchen"))) is Atom
    assert type(term("kitchen")) is String
    assert term(Atom("kitchen")) is atom("kitchen")


def test_atoms_that_are_not_plain_words_are_quoted_and_prefixed():
    assert term(Atom("Living room")) is atom("'Living room'")
    assert to_value(atom("'Living room'")) == "Living room"
    assert atom_of("Odom") is atom("'Odom'")
    assert atom_of("odom_1") is atom("odom_1")
    assert atom_of("not") is atom("'not'")
    negated = (functor("p", 1, True, "lab"), 1.0)
    assert to_value(negated) == Structure("lab::~p", (1,))
    assert term(Structure("lab::~p", (1,))) == negated


def test_structures_and_long_lists_are_converted_inside():
    nested = structure("at", 1.0, make_list([String("a"), atom("b"), NIL]))
    value = to_value(nested)
    assert value == Structure("at", (1, ["a", Atom("b"), []]))
    assert term(value) == nested
    items = to_value(make_list([float(i) for i in range(20_000)]))
    assert items == list(range(20_000))
    assert sum(list_items(term(items))) == sum(range(20_000))
    assert to_value(Annotated(atom("a"), (atom("b"),))) == Atom("a")
    relation = (functor("<", 2, kind=3), 1.0, 2.0)
    assert to_value(relation) == "(1 < 2)"


def test_an_unbound_variable_becomes_an_output_and_none_a_variable():
    outputs: list[tuple[Var, Out]] = []
    x, y, bound = Var("X"), Var("Y"), Var("Z")
    bound.ref = 3.0
    values = [to_value(t, outputs) for t in (x, bound, make_list([y]))]
    assert [variable for variable, _ in outputs] == [x, y]
    assert values[0] is outputs[0][1]
    assert values[1] == 3
    assert values[2] == [outputs[1][1]]
    assert term(None).__class__ is Var
    out = Out()
    assert term(out).__class__ is Var
    out.set("x")
    assert term(out) == String("x")


def test_other_objects_are_opaque_references():
    thing = object()
    reference = term(thing)
    assert isinstance(reference, Reference)
    assert to_value(reference) is thing
    assert reference == term(thing)
    references = References()
    artifact = ArtifactId("c", "Counter", "/main", 1, None)
    reference = to_term(artifact, references)
    assert to_term(artifact, references) is reference
    assert to_value(reference) is artifact
    references.forget(artifact)
    assert to_term(artifact, references) == reference


def test_numpy_values_and_dataclasses_are_turned_into_terms():
    @dataclasses.dataclass
    class Pose:
        x: float
        room: str

    assert term(numpy.float32(0.5)) == 0.5
    assert text(term(numpy.array([[1, 2], [3, 4]]))) == "[[1,2],[3,4]]"
    assert text(term(Pose(1.5, "hall"))) == 'pose(1.5,"hall")'


def test_maps_and_sets_become_dictionaries_and_sorted_lists():
    value = to_value(MapValue({atom("a"): 1.0, make_list([2.0]): String("b")}))
    assert value == {Atom("a"): 1, (2,): "b"}
    back = term(value)
    assert isinstance(back, MapValue)
    assert back.items == {atom("a"): 1.0, make_list([2.0]): String("b")}
    assert to_value(SetValue({2.0: None, 1.0: None})) == [1, 2]


LAMP = ArtifactId("Lamp", "Lamp", "/main/lab", 1, None)
MAIN = SimpleNamespace(member="")


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


def test_percepts_have_references_causes_and_any_values():
    write = writer()
    first, second = [
        write.percepts(Observation(LAMP, added=(observable("on", i),)))[0].annotations for i in (1, 2)
    ]
    assert first is second
    why = Cause(1, 0, "sample", "odom")
    assert writer().percepts(Observation(LAMP, added=(observable("on"),), cause=why))[0].cause is why
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
