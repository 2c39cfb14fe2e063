"""Annotations of parameters: what agents may pass, what the operation receives, and the messages of failures."""

import collections.abc
import enum
import typing
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, NamedTuple, NewType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jacaros.agents.body.values import References, to_term, to_value
from jacaros.artifacts import Artifact, Atom, Out, Structure, operation, plain
from jacaros.artifacts.env.values import equal
from jacaros.artifacts.kernel.acceptance import Unsuitable, kind_of


class Mode(enum.Enum):
    AUTO = "automatic"
    MANUAL = 2


class Level(enum.IntEnum):
    LOW = 1
    HIGH = 2


class Colour(enum.StrEnum):
    RED = "red"


@dataclass(frozen=True)
class Pose:
    x: float
    y: float
    frame: str = "map"


@dataclass
class Path:
    name: str
    poses: list[Pose] = field(default_factory=list)


@dataclass
class Positive:
    value: int

    def __post_init__(self):
        if self.value <= 0:
            raise ValueError(f"{self.value} is not positive")


@dataclass
class Home:
    pass


@dataclass
class Unresolved:
    thing: "NoSuchName"  # noqa: F821


class Cell(NamedTuple):
    row: int
    column: int = 0


Metres = NewType("Metres", float)


def received(annotation, argument):
    return kind_of(annotation).accept(argument)


@pytest.mark.parametrize(
    ("annotation", "argument", "expected"),
    [
        (Mode, Atom("auto"), Mode.AUTO),
        (Mode, "AUTO", Mode.AUTO),
        (Mode, "automatic", Mode.AUTO),
        (Mode, 2.0, Mode.MANUAL),
        (Level, 2, Level.HIGH),
        (Level, Atom("low"), Level.LOW),
        (Colour, "red", Colour.RED),
        (Pose, Structure("pose", (1, 2.5)), Pose(1.0, 2.5)),
        (Pose, Structure("pose", (1, 2, Atom("odom"))), Pose(1.0, 2.0, "odom")),
        (Pose, Pose(1, 2), Pose(1, 2)),
        (
            Path,
            Structure("path", ("p", [Structure("pose", (1, 2)), Structure("pose", (3, 4))])),
            Path("p", [Pose(1.0, 2.0), Pose(3.0, 4.0)]),
        ),
        (Path, Structure("path", (Atom("p"),)), Path("p")),
        (Home, Atom("home"), Home()),
        (Unresolved, Structure("unresolved", ([1],)), Unresolved([1])),
        (Cell, Structure("cell", (3.0, 4)), Cell(3, 4)),
        (Cell, Structure("cell", (3,)), Cell(3)),
        (Pose | Cell, Structure("cell", (3, 4)), Cell(3, 4)),
        (tuple[int, str], [1, "a"], (1, "a")),
        (tuple[float, ...], [1, 2, 3], (1.0, 2.0, 3.0)),
        (tuple, [1, "a"], (1, "a")),
        (typing.Tuple, [1], (1,)),  # noqa: UP006
        (collections.abc.Sequence[int], [1.0], [1]),
        (collections.abc.Iterable[str], ["a"], ["a"]),
        (collections.abc.Mapping[str, object], {"a": [1]}, {"a": [1]}),
        (list[list[int]], [[1], [2.0]], [[1], [2]]),
        (list[Any], [Out, "x"], [Out, "x"]),
        (Metres, 3, 3.0),
        (Annotated[int, "a note"], 3.0, 3),
        (Literal[1, "on"], 1.0, 1),
        (int | Literal["all"], "all", "all"),
        (None, None, None),
    ],
)
def test_an_argument_becomes_what_the_annotation_says(annotation, argument, expected):
    got = received(annotation, argument)
    assert got == expected
    assert type(got) is type(expected) or isinstance(got, (Atom, float))


@pytest.mark.parametrize(
    ("annotation", "argument", "expected", "part"),
    [
        (Mode, Atom("fast"), "one of auto, manual", ""),
        (Level, 3, "one of low, high", ""),
        (Pose, Structure("pos", (1, 2)), "pose(x: a number, y: a number, frame: a text (optional))", ""),
        (Pose, Structure("pose", (1,)), "pose(x: a number, y: a number", "it has 1 arguments"),
        (Pose, Structure("pose", (1, Atom("a"))), "pose(", "y is a"),
        (
            Path,
            Structure("path", ("p", [Structure("pose", (1, "a"))])),
            "path(",
            'poses is [pose(1,"a")]: element 1 is pose(1,"a"): y is "a"',
        ),
        (Positive, Structure("positive", (-3,)), "positive(value: an integer)", "-3 is not positive"),
        (Home, Atom("away"), "home", ""),
        (Cell, [1, 2], "cell(row: an integer, column: an integer (optional))", ""),
        (tuple[int, str], [1], "a list of 2 (an integer, a text)", "it has 1 elements"),
        (tuple[int, str], ["a", "b"], "a list of 2 (an integer, a text)", 'element 1 is "a"'),
        (tuple[int, str], "ab", "a list of 2", ""),
        (list[int], [1, "b", 3], "a list, each an integer", 'element 2 is "b"'),
        (
            list[list[int]],
            [[1], [2, "x"]],
            "a list, each a list, each an integer",
            'element 2 is [2,"x"]: element 2 is "x"',
        ),
        (list[int], [Out()], "a list, each an integer", "element 1 is an unbound variable"),
        (dict, [1], "a map", ""),
        (collections.abc.Mapping, "x", "a map", ""),
        (Literal["on", True], "off", '"on" or true', ""),
        (Literal[1], True, "1", ""),
        (int | list[int], ["a"], "an integer or a list, each an integer", 'element 1 is "a"'),
        (np.ndarray, [1, 2], "ndarray", ""),
    ],
)
def test_a_failure_names_what_was_expected_and_the_part_that_is_wrong(annotation, argument, expected, part):
    kind = kind_of(annotation)
    assert expected in kind.expected
    with pytest.raises(Unsuitable) as caught:
        kind.accept(argument)
    assert str(caught.value) == part


def test_a_type_alias_of_python_3_12_is_looked_through():
    class TypeAliasType:  # stands for that of Python 3.12
        __value__ = list[int]

    assert received(TypeAliasType(), [1.0]) == [1]


class Typed(Artifact):
    @operation
    def go(self, pose: Pose, speeds: list[float], mode: Mode = Mode.AUTO, *more: int):
        self.log(f"{pose} {speeds} {mode}")


async def test_an_operation_fails_with_a_message_that_names_the_parameter(stage):
    typed = await stage.make(Typed)
    at = Structure("pose", (1, 2))
    assert stage.call(typed, "go", at, [1], Atom("manual"), 3).ok
    for arguments, said in [
        (
            (at, [1, "fast"]),
            'argument 2 (speeds): expected a list, each a number, found [1,"fast"]: element 2 is "fast"',
        ),
        ((at, [1], Atom("x")), "argument 3 (mode): expected one of auto, manual, found x"),
        ((at, [1], Atom("auto"), 1, 1.5), "argument 5 (more): expected an integer, found 1.5"),
        ((at, list("abcdefghijklmnopqrstuvwxyz0123456789" * 9)), '"2","3"...: element 1 is "a"'),
        ((Out(), [1]), "(optional)), found an unbound variable"),
    ]:
        call = stage.call(typed, "go", *arguments)
        assert call.reason == Structure("wrong_op_arguments", (typed, f"go/{len(arguments)}"))
        assert said in call.outcome.message
    assert stage.lines == ["[it] Pose(x=1.0, y=2.0, frame='map') [1.0] Mode.MANUAL"]


FINITE = st.floats(allow_nan=False, allow_infinity=False)
SMALL = st.integers(-(2**53), 2**53)
WORDS = st.text(max_size=8)
VALUES = [
    (int, SMALL),
    (float, FINITE),
    (bool, st.booleans()),
    (str, WORDS),
    (
        Atom,
        st.from_regex(r"[a-z][a-zA-Z0-9_]{0,5}", fullmatch=True)
        .filter(lambda a: a not in ("true", "false"))
        .map(Atom),
    ),
    (Mode, st.sampled_from(Mode)),
    (Level, st.sampled_from(Level)),
    (Pose, st.builds(Pose, FINITE, FINITE, WORDS)),
    (Path, st.builds(Path, WORDS, st.lists(st.builds(Pose, FINITE, FINITE, WORDS), max_size=3))),
    (Cell, st.builds(Cell, SMALL, SMALL)),
    (list[int], st.lists(SMALL, max_size=4)),
    (tuple[int, str], st.tuples(SMALL, WORDS)),
    (dict[str, float], st.dictionaries(WORDS, FINITE, max_size=3)),
]


@given(st.one_of([strategy.map(lambda value, kind=kind: (kind, value)) for kind, strategy in VALUES]))
def test_what_an_artifact_gives_comes_back_as_it_was(case):
    kind, value = case
    given_away = plain(value)
    term = to_term(given_away, References())
    back = to_value(term)
    assert equal(back, given_away) or isinstance(back, dict)
    assert received(kind, back) == value


@given(
    st.recursive(
        SMALL | FINITE | WORDS | st.booleans(), lambda inner: st.lists(inner, max_size=3), max_leaves=8
    )
)
def test_any_input_is_taken_as_it_is_where_nothing_is_said(value):
    assert received(object, value) is value


@pytest.mark.parametrize("argument", [Atom("kitchen"), "kitchen"])
def test_a_text_is_a_text_however_it_was_written(argument: str) -> None:
    got = received(str, argument)
    assert (got, type(got)) == ("kitchen", str)
    assert type(received(Atom | str, Atom("kitchen"))) is Atom
