"""Signatures: accepted arguments and their conversion."""

from typing import Any, Literal, NewType, Optional, Protocol

import pytest

from jacaros.artifacts import ArtifactId, Atom, InvalidArtifact, Out, Structure
from jacaros.artifacts.kernel.declaration import ArgumentMismatch, signature_of


def signature(function):
    return signature_of(function, skip_first=False)


def accepted(annotation, argument):
    def f(x):
        pass

    f.__annotations__["x"] = annotation
    return signature(f).bind((argument,))[0]


def refused(annotation, argument):
    with pytest.raises(ArgumentMismatch) as caught:
        accepted(annotation, argument)
    return str(caught.value)


def test_arities_follow_from_defaults_and_outputs():
    def f(a, b: Out, c=1, d: int = 2):
        pass

    assert list(signature(f).arities) == [2, 3, 4]
    assert not signature(f).takes(5)
    assert str(signature(f)) == "a: any value, -b, c: any value (optional), d: an integer (optional)"


def test_any_number_of_arguments():
    def f(a: int, *rest: object):
        pass

    assert [signature(f).takes(n) for n in range(4)] == [False, True, True, True]
    out = Out()
    assert signature(f).bind((1, out, "x")) == (1, out, "x")
    assert str(signature(f)) == "a: an integer, ..."


def test_further_arguments_are_checked_when_annotated():
    def f(*numbers: int):
        pass

    assert signature(f).bind((1, 2.0)) == (1, 2)
    with pytest.raises(ArgumentMismatch, match=r"argument 2 \(numbers\): expected an integer"):
        signature(f).bind((1, Out()))


def test_agents_cannot_pass_keyword_parameters():
    def keyword(*, a):
        pass

    def more(**a):
        pass

    for function in (keyword, more):
        with pytest.raises(InvalidArtifact, match="keyword parameter a"):
            signature(function)


def test_a_method_needs_self():
    def bare():
        pass

    with pytest.raises(InvalidArtifact, match="bare: expected self as first parameter"):
        signature_of(bare, skip_first=True)


@pytest.mark.parametrize(
    ("annotation", "argument", "received"),
    [
        (int, 3, 3),
        (int, 3.0, 3),
        (float, 3, 3.0),
        (float, 0.1, 0.1),
        (str, "a", "a"),
        (str, Atom("a"), "a"),
        (bool, True, True),
        (list, [1, "a"], [1, "a"]),
        (list[int], [1, 2.0], [1, 2]),
        (dict, {"a": 1}, {"a": 1}),
        (dict[str, float], {"a": 1}, {"a": 1.0}),
        (Atom, Atom("a"), Atom("a")),
        (Structure, Structure("p", (1,)), Structure("p", (1,))),
        (int | str, "a", "a"),
        (float | int, 3, 3),
        (float | str, 3, 3.0),
        (Optional[int], None, None),  # noqa: UP045
        (int | None, 3.0, 3),
        (Literal["on", "off"], "on", "on"),
        (object, [1], [1]),
        (Any, "x", "x"),
    ],
)
def test_suitable_arguments_are_received(annotation, argument, received):
    got = accepted(annotation, argument)
    assert got == received
    assert type(got) is type(received) or isinstance(got, Atom)


@pytest.mark.parametrize(
    ("annotation", "argument", "expected"),
    [
        (int, 3.5, "an integer"),
        (int, True, "an integer"),
        (int, float("nan"), "an integer"),
        (int, float("inf"), "an integer"),
        (float, True, "a number"),
        (float, "1", "a number"),
        (str, 1, "a text"),
        (bool, 1, "true or false"),
        (list, "abc", "a list"),
        (list[int], ["a"], "a list, each an integer"),
        (list[int], "a", "a list, each an integer"),
        (dict[str, int], [1], "a map"),
        (Atom, "string", "an atom"),
        (Structure, Atom("p"), "a structure"),
        (int | str, [1], "an integer or a text"),
        (Optional[int], "x", "an integer or nothing"),  # noqa: UP045
        (Literal["on", "off"], "of", '"on" or "off"'),
        (ArtifactId, "name", "ArtifactId"),
        (object, Out(), "any value"),
        (Any, Out(), "any value"),
        (Out, 1, "an unbound variable"),
    ],
)
def test_unsuitable_arguments_are_refused_with_what_was_expected(annotation, argument, expected):
    message = refused(annotation, argument)
    assert f"argument 1 (x): expected {expected}" in message


def test_an_unannotated_parameter_takes_any_input_but_no_output():
    def f(x):
        pass

    assert signature(f).bind((object,)) == (object,)
    with pytest.raises(ArgumentMismatch):
        signature(f).bind((Out(),))


def test_a_parameter_may_take_inputs_and_outputs():
    out = Out()
    assert accepted(int | Out, out) is out
    assert accepted(int | Out, 3.0) == 3


def test_annotations_written_as_text_are_understood():
    def f(a: "int", b: "Out", c: "SomewhereElse", d: "some.module.Out", e: int):  # noqa: F821
        pass

    found = signature(f)
    assert [parameter.output for parameter in found.parameters] == [False, True, False, True, False]
    assert found.parameters[4].expected == "an integer"


def test_an_annotation_that_is_not_a_type_accepts_any_input():
    assert accepted(list[Any] | Literal[3], [1, "a"]) == [1, "a"]

    class Sized(Protocol):
        def size(self): ...

    assert accepted(Sized, 5) == 5
    assert accepted(NewType("Metres", float), 5) == 5

    def f(x: "a note for people"):  # noqa: F722
        pass

    assert signature(f).bind((1,)) == (1,)
