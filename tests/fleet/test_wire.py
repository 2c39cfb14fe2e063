"""Terms and values keep their form on the wire, and what cannot cross says so."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Reference
from jacaros.artifacts import Atom, Out, Structure
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.fleet import protocol
from jacaros.fleet.wire import NotSendable, Wire

LAMP = ArtifactId("lamp", "Lamp", "/main", 7, None)
WIRE = Wire(lambda artifact: ("run", 1, "lamp", "Lamp", "/main"), lambda name: LAMP)


def sent(data: object) -> object:
    """Return data as it arrives."""
    said = protocol.read(protocol.write(protocol.Ended(1, True, None, data, [], None)))
    assert isinstance(said, protocol.Ended)
    return said.reason


@pytest.mark.parametrize(
    "written",
    [
        *("a", "'A b'", "~a", "ns::a", "f(1,2.5,-3)", '"text with \\"quotes\\""', "[]", "[1,[a,b],c]"),
        *("p(1)[source(bob),q(2)]", "~p(a)", "ns::p(1)", "{ +!g(1) : b(2) <- !h; .print(3) }", "f(g(h(i)))"),
        *("9007199254740993", "123456789012345678901234567890", "{ a; b(1) }"),
    ],
)
def test_a_term_arrives_as_it_was_sent(written: str) -> None:
    term = lower_value(parse_term(written))
    arrived = WIRE.to_term(sent(WIRE.from_term(term)))
    assert text(arrived) == text(term)
    assert type(arrived) is type(term)


def test_one_variable_stays_one_variable() -> None:
    arrived = WIRE.to_term(sent(WIRE.from_term(lower_value(parse_term("f(X,Y,X)")))))
    assert arrived[1] is arrived[3]
    assert arrived[1] is not arrived[2]


_SCALARS = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.text().map(Atom)
)
_KEYS = st.integers() | st.text() | st.tuples(st.integers(), st.text())
_VALUES = st.recursive(
    _SCALARS,
    lambda inner: (
        st.lists(inner)
        | st.dictionaries(_KEYS, inner)
        | st.frozensets(st.integers())
        | st.builds(Structure, st.text(min_size=1), st.lists(inner, min_size=1).map(tuple))
    ),
    max_leaves=20,
)


@given(_VALUES)
def test_a_value_arrives_as_it_was_sent(value: object) -> None:
    arrived = WIRE.to_value(sent(WIRE.from_value(value)))
    assert arrived == value
    assert type(arrived) is type(value)


def test_artifacts_and_output_parameters_cross() -> None:
    assert WIRE.to_value(sent(WIRE.from_value([LAMP]))) == [LAMP]
    assert WIRE.to_term(sent(WIRE.from_term(Reference(LAMP)))).value is LAMP
    here: list[Out] = []
    there: list[Out] = []
    one, other = Out(), Out()
    arrived = WIRE.to_value(sent(WIRE.from_value([one, other, one], here)), there)
    assert here == [one, other]
    assert arrived == [there[0], there[1], there[0]]


@pytest.mark.parametrize("value", [object(), [1, object()], Structure("f", (object(),)), {"a": object()}])
def test_an_object_of_python_cannot_cross(value: object) -> None:
    with pytest.raises(
        NotSendable, match="a value of the class object cannot be sent to another system: send its parts"
    ):
        WIRE.from_value(value)


@pytest.mark.parametrize(
    "data",
    [
        *([], [0], [1], [1, 7], [3], [4], [5, 1], [8, 1], [9, "x"], [77, 1], {"a": 1}),
        *([0, ["a", 1, 2]], [0, ["a", 0, 0, 99]], [2, [2, []]]),
    ],
)
def test_data_of_a_stranger_that_is_not_a_term_is_refused(data: object) -> None:
    with pytest.raises((ValueError, LookupError, TypeError)):
        WIRE.to_term(data)
