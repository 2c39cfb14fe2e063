"""`history` in mapping files: agents that focus the artifact ask for past values, without a directive of their own."""

from pathlib import Path

import pytest

from jacaros.artifacts.mapping.declared import MappingError
from jacaros.artifacts.mapping.file import read_mapping
from jacaros.mas.checking import check_files
from jacaros.testing.run import run_project

SONAR = """
properties:
  range: {topic: front/range, type: std_msgs/msg/Float64, fields: [data], history: 2}
  other: {topic: front/range, type: std_msgs/msg/Float64, fields: [data]}
derived:
  nearest: {min: range, within: 0.2, history: 1}
operations:
  echo: {parameters: [metres], publish: front/range, type: std_msgs/msg/Float64, fields: {data: $metres}}
"""
ECHOES = "echo(4); .wait(500); echo(2); .wait(300)"
ASK = "if (range(X)[ago(500)]) { .print(X) } else { .print(none) }"


def run(folder: Path, program: str, focus: str = "focus: main.sonar") -> list[str]:
    """What an agent prints."""
    (folder / "sonar.yaml").write_text(SONAR)
    (folder / "a.asl").write_text(program)
    project = folder / "lab.jcm"
    project.write_text(f'mas lab {{ agent a {{ {focus} }} mapping: "sonar.yaml" }}')
    result = run_project(project, until_idle=True)
    assert result.errors == []
    assert [each.message for each in check_files([project]).diagnostics] == []
    return [line.removeprefix("[a] ") for line in result.lines]


@pytest.mark.parametrize(
    ("body", "printed"),
    [
        (f"{ECHOES}; {ASK}", ["4"]),
        (f"{ECHOES}; .wait(2000); {ASK}", ["2"]),
        (f"{ECHOES}; ?nearest(X)[ago(700)]; .print(X); ?nearest(Y)[ago(200)]; .print(Y)", ["4", "2"]),
        (f"{ECHOES}; for (range(X)[ago(500), source(percept)]) {{ .print(X) }}", ["4"]),
        (
            f"{ECHOES}; .wait(500); if (nearest(X)[ago(1001)]) {{ .print(X) }} else {{ .print(none) }}",
            ["none"],
        ),
        (f"lookupArtifact(sonar, S); stopFocus(S); {ECHOES}; focus(S); .wait(100); {ASK}", ["none"]),
        (f"{ECHOES}; lookupArtifact(sonar, S); stopFocus(S); .wait(100); {ASK}", ["4"]),
    ],
)
def test_an_agent_asks_for_past_values(tmp_path: Path, body: str, printed: list[str]) -> None:
    assert run(tmp_path, f"!start. +!start <- {body}.") == printed


def test_a_namespace_has_histories_of_its_own(tmp_path: Path) -> None:
    ask = ASK.replace("range", "front::range")
    assert run(tmp_path, f"!start. +!start <- {ECHOES}; {ask}.", "focus: front::main.sonar") == ["4"]


def test_a_clone_inherits_the_history(tmp_path: Path) -> None:
    program = f"!start. +!start <- {ECHOES}; .clone(b); .send(b, achieve, ask). +!ask <- {ASK}."
    assert run(tmp_path, program) == ["[b] 4"]


def test_check_reports_the_past_of_a_property_without_a_history(tmp_path: Path) -> None:
    (tmp_path / "sonar.yaml").write_text(SONAR)
    (tmp_path / "a.asl").write_text("!s. +!s : other(X)[ago(10)] & range(Y)[ago(10)] <- .print(X, Y).")
    project = tmp_path / "lab.jcm"
    project.write_text('mas lab { agent a { focus: main.sonar } mapping: "sonar.yaml" }')
    [told] = check_files([project]).diagnostics
    assert (told.message, told.code) == (
        "no history of `other(_)` is kept: `ago` finds nothing",
        "no-history",
    )
    assert (
        told.help
        == "declare `{ history(other(_), within(2000)) }`, or `history: 2` in the mapping file of a property"
    )


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("properties: {a: {topic: a, history: 0}}", "'history' is 0, but must be above zero | leave"),
        ("properties: {a: {topic: a, history: -2}}", "'history' is -2, but must be above zero | leave"),
        (
            "properties: {a: {topic: a, history: 86401}}",
            "'history' is longer than a day | write at most 86400 s",
        ),
        (
            "properties: {a: {topic: a, history: .inf}}",
            "'history' must be a number, not inf | write a figure",
        ),
        (
            "properties: {a: {topic: a, history: true}}",
            "'history' must be a number, not True | write a figure",
        ),
        ("frames: {p: {target: map, source: base, history: 0}}", "'history' is 0, but must be above zero"),
        ("signals: {s: {topic: s, history: 2}}", "'s' has no key 'history' | known keys: topic"),
        (
            "{signals: {s: s}, derived: {x: {sequence: [s, s], within: 1, history: 2}}}",
            "`sequence` is an event and has no history | leave `history` out",
        ),
    ],
)
def test_what_is_wrong_with_a_history_is_reported(text: str, told: str) -> None:
    with pytest.raises(MappingError) as caught:
        read_mapping(text)
    found = [f"{each.message} | {each.help}" for each in caught.value.problems]
    assert len(found) == 1
    assert found[0].startswith(told), found
