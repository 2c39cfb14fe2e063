"""Files that are not YAML, or not text: place, message and help, without terms of the parser."""

from pathlib import Path

import pytest

from jacaros.robots.mapping.file import MappingError, load_mapping, read_mapping
from jacaros.runtime.files.yaml import Problem, read_document

LAUGHS = "a: &a [1,1,1,1,1,1,1,1,1,1]\n" + "".join(
    f"{new}: &{new} [{','.join([f'*{old}'] * 10)}]\n" for old, new in zip("abcdefg", "bcdefgh", strict=True)
)


def problems(text: str) -> list[Problem]:
    found: list[Problem] = []
    read_document(text, found, "a file")
    return found


@pytest.mark.parametrize(
    ("text", "place", "message", "help"),
    [
        ("a:\n\tb: c\n", (2, 1), "a tab in the indent", "spaces"),
        ("a:\n  b: 1\n c: 2\n", (3, 2), "the indent fits none of the lines above", "same column"),
        ("a:\n  b: {c: d\n", (2, 6), "this bracket is never closed", "close"),
        ("a: 'x\nb: c\n", (1, 4), "this quote is never closed", "close"),
        ("a: [b[0]]\n", (1, 6), "a bracket within a text", 'quotes: "ranges[0]"'),
        ("a: {b: c d: e}\n", (1, 11), "within the bracket of line 1, column 4", "commas"),
        ("a: {b: c}}\n", (1, 10), "unmatched bracket", "remove it"),
        ("a: b: c\n", (1, 5), "a second ':'", "quotes"),
        ("a: *x\n", (1, 4), "unknown anchor &x", "mark the value with &x"),
        ("a: 1\n---\nb: 2\n", (2, 1), "a second document", "remove ---"),
        ("a: @x\n", (1, 4), "cannot start any token", "quotes"),
        ("b: 1\na: \x07\n", (2, 4), "invalid character", "UTF-8"),
        ("<<: 5\na: 1\n", (1, 5), "<< merges the keys of a mapping", "anchor"),
        ("a: &a [*a]\n", (1, 4), "&a contains itself", "remove the alias"),
        (LAUGHS, (6, 4), "more than 1000000 values", "fewer aliases"),
        ("a: " + "[" * 5000, (1, 1), "nested too deeply", "brackets"),
    ],
)
def test_mistakes_of_syntax(text: str, place: tuple[int, int], message: str, help: str) -> None:
    (problem,) = problems(text)
    assert (problem.line, problem.column) == place
    assert message in problem.message
    assert help in problem.help


@pytest.mark.parametrize(
    ("data", "place", "message"),
    [
        (b"properties:\n  p\xe9: {topic: odom}\n", "m.yaml:2:4", "the byte 0xe9 is not UTF-8"),
        ("properties:\n".encode("utf-16"), "m.yaml:1:1", "the file is in UTF-16"),
        (bytes(range(256)), "m.yaml:1:1", "the file is not text"),
    ],
)
def test_files_in_another_encoding(data: bytes, place: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_bytes(data)
    with pytest.raises(MappingError) as caught:
        load_mapping(tmp_path / "m.yaml")
    assert place in str(caught.value)
    assert message in str(caught.value)


def test_a_byte_order_mark_is_harmless(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_bytes(b"\xef\xbb\xbfproperties: {pose: odom}\r\n")
    assert [each.name for each in load_mapping(tmp_path / "m.yaml").artifacts["m"].properties] == ["pose"]


def test_anchors_have_a_place_of_their_own() -> None:
    text = "x-slow: &slow {rate: 2}\nproperties:\n  a: {<<: *slow, topic: a}\n  b: {<<: *slow, topic: b, rate: 3}\n"
    artifact = read_mapping(text, "m.yaml").artifacts["m"]
    assert [each.policy.rate for each in artifact.properties] == [2.0, 3.0]


def test_reserved_words_are_not_names() -> None:
    with pytest.raises(MappingError) as caught:
        read_mapping(
            "properties:\n  not: {topic: a}\n  for: {topic: b}\n  true: {topic: c}\n  Div: {topic: d}\n  g:\n"
        )
    told = str(caught.value)
    assert "m" in told
    assert [problem.line for problem in caught.value.problems] == [2, 3, 4, 5, 6]
    assert "`not` is a reserved word in agent programs" in told
    assert "unnamed" not in told


def test_a_slip_in_the_kind_of_an_operation() -> None:
    with pytest.raises(MappingError, match="did you mean `publish`"):
        read_mapping("operations:\n  go: {publsh: x}\n")
