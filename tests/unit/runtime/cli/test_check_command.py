"""``jacaros check``: what it reads, how it reports, its exit codes."""

import json
from pathlib import Path

import pytest
from command_lab import Outcome

COMMAND = ("check",)

ROOT = Path(__file__).parents[4]

GOOD = "!go.\n+!go <- .print(hi).\n"
WARNED = "!go.\n+!go <- .print(hi); .prnt(X).\n"
WRONG = "!go.\n+!go <- a(; b c.\n+!other <- d(X).\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in (("good", GOOD), ("warned", WARNED), ("wrong", WRONG)):
        (tmp_path / f"{name}.asl").write_text(text, encoding="utf-8")
    return tmp_path


def found(outcome: Outcome, *arguments: str) -> list[tuple[str, int, str]]:
    """Return file, line and code of all reported problems."""
    _, output, _ = outcome(*arguments, "--format", "json")
    return [(each["file"], each["line"], each["code"]) for each in json.loads(output)["diagnostics"]]


LONG = 300 * "b"
"""No file can have this name."""


def test_a_correct_program_has_no_problems_and_a_wrong_one_all_in_one_pass(
    folder: Path, outcome: Outcome
) -> None:
    assert outcome("good.asl", "--strict") == (0, "", "nothing wrong in 1 file\n")
    assert outcome("wrong.asl")[0] == 1
    assert found(outcome, "wrong.asl") == [
        ("wrong.asl", 2, "unexpected-token"),
        ("wrong.asl", 2, "missing-semicolon"),
        ("wrong.asl", 3, "singleton-variable"),
    ]


def test_warnings_are_reported_and_fail_only_with_strict(folder: Path, outcome: Outcome) -> None:
    code, output, errors = outcome("warned.asl")
    assert code == 0
    assert output.startswith(
        "warned.asl:2:21: warning: unknown internal action `.prnt` [unknown-internal-action]\n"
        "  2 | +!go <- .print(hi); .prnt(X).\n"
        "    |                     ^^^^^^^^\n"
        "  = help: did you mean `.print`?\n"
    )
    assert errors == "2 warnings in 1 file\n"
    assert outcome("warned.asl", "--strict")[0] == 1
    ignored = ("--ignore", "singleton-variable", "--ignore", "unknown-internal-action")
    assert outcome("warned.asl", "--strict", *ignored)[0] == 0


def test_a_folder_is_checked_with_its_projects(folder: Path, outcome: Outcome) -> None:
    (folder / "p.mas2j").write_text('MAS p { agents: bob good.asl [goals="fly"]; }', encoding="utf-8")
    (folder / "part.asl").write_text("+!part <- !defined_elsewhere.", encoding="utf-8")
    whole = '{ include("part.asl") }\n!part. +!defined_elsewhere.'
    (folder / "whole.asl").write_text(whole, encoding="utf-8")
    (folder / ".hidden").mkdir()
    (folder / ".hidden" / "x.asl").write_text("(", encoding="utf-8")
    assert {code for file, _, code in found(outcome, ".") if file == "part.asl"} == set()
    assert ("p.mas2j", 1, "unknown-goal") in found(outcome, ".")
    assert found(outcome, "part.asl") == [("part.asl", 1, "unknown-goal")]


def test_a_plan_before_an_include_may_override_an_included_one(folder: Path, outcome: Outcome) -> None:
    (folder / "part.asl").write_text("+!go <- .print(part).", encoding="utf-8")
    (folder / "before.asl").write_text('+!go. { include("part.asl") } !go.', encoding="utf-8")
    (folder / "behind.asl").write_text('{ include("part.asl") } +!go. !go.', encoding="utf-8")
    assert found(outcome, "before.asl") == []
    assert found(outcome, "behind.asl") == [("behind.asl", 1, "plan-never-selected")]


def test_projects_are_checked(folder: Path, outcome: Outcome) -> None:
    (folder / "p.jcm").write_text(
        "mas p {\n  agent bob : warned.asl\n  agent eve : nowhere.asl\n  agent joe : good.asl { focus: thing }\n}\n",
        encoding="utf-8",
    )
    assert found(outcome, "p.jcm") == [
        ("p.jcm", 3, "wrong-project"),
        ("p.jcm", 4, "wrong-project"),
        ("warned.asl", 2, "unknown-internal-action"),
        ("warned.asl", 2, "singleton-variable"),
    ]


def test_internal_actions_of_neighbouring_modules_are_known(folder: Path, outcome: Outcome) -> None:
    (folder / "own.asl").write_text("!go. +!go <- my.act(1); your.act(1).", encoding="utf-8")
    (folder / "my.py").write_text(
        "from jacaros import internal_action\n\n@internal_action\ndef act(x):\n    return True\n",
        encoding="utf-8",
    )
    assert found(outcome, "own.asl") == [("own.asl", 1, "unknown-internal-action")]
    (folder / "your.py").write_text("oh dear", encoding="utf-8")
    assert (None, None, "unreadable-file") in found(outcome, "own.asl")


def test_unreadable_files_are_reported(folder: Path, outcome: Outcome) -> None:
    (folder / "bytes.asl").write_bytes(b"p(\xff).")
    code, output, _ = outcome("bytes.asl")
    assert code == 1
    assert "cannot read bytes.asl" in output
    assert "[unreadable-file]" in output


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["godo.asl"], "did you mean `good.asl`?"),
        (["good.asl", "--ignore", "nonsense"], "unknown code: `nonsense`"),
        (
            ["notes.txt"],
            "unsupported file type: `notes.txt`\n  = help: expected .asl, .mas2j, .jcm, .py, .yaml, .yml",
        ),
        ([], "FILE"),
    ],
)
def test_wrong_usage(folder: Path, outcome: Outcome, arguments: list[str], told: str) -> None:
    (folder / "notes.txt").write_text("")
    code, _, errors = outcome(*arguments)
    assert code == 2
    assert told in errors


def test_an_unclosed_bracket_is_reported(folder: Path, outcome: Outcome) -> None:
    (folder / "open.asl").write_text("+!g <- a(1,\n  2; b.", encoding="utf-8")
    (told,) = json.loads(outcome("open.asl", "--format", "json")[1])["diagnostics"]
    assert (told["line"], told["opened"]) == (2, [1, 9])


def test_output_is_coloured_only_on_terminals(folder: Path, outcome, monkeypatch):
    assert "\x1b[" not in outcome("warned.asl")[1]
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[" in outcome("warned.asl")[1]
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[" not in outcome("warned.asl")[1]


def test_a_name_longer_than_that_of_a_file_is_only_a_name(folder: Path, outcome: Outcome) -> None:
    (folder / "long.asl").write_text(f"!go.\n+!go <- {LONG}.x(1); act.\n")
    assert [
        each["code"] for each in json.loads(outcome("long.asl", "--format", "json")[1])["diagnostics"]
    ] == ["unknown-internal-action"]
    code, _, errors = outcome(f"{LONG}.asl")
    assert (code, errors.splitlines()[0]) == (2, f"error: file not found: `{LONG}.asl`")


def test_the_order_of_files_changes_nothing(folder: Path, outcome: Outcome) -> None:
    (folder / "tester.asl").write_text("!start.\n+!start <- .send(mock, tell, owner(me)).\n")
    (folder / "mock.asl").write_text("!sleep.\n+!sleep : owner(Who) <- .print(Who).\n+!sleep.\n")
    orders = (("mock.asl", "tester.asl"), ("tester.asl", "mock.asl"))
    assert [outcome(*order, "--strict")[0] for order in orders] == [0, 0]


def test_the_programs_of_the_repository_have_no_problems(outcome: Outcome) -> None:
    folders = ("examples", "tests/compatibility", "tests/integration", "benchmarks/latency")
    shipped = [each for each in (ROOT / "src").rglob("*.*") if each.suffix in (".asl", ".yaml")]
    shipped = [
        each for each in shipped if "templates" not in each.parts
    ]  # tested as what `jacaros new` makes
    code, output, _ = outcome("--strict", *(str(ROOT / each) for each in folders), *map(str, shipped))
    assert (code, output) == (0, "")


MEANT = {
    "body_statements/control_statements_as_internal_actions": {"never-matches"},
    "body_statements/if_without_else": {"unknown-belief"},
    "concurrency/fork_with_needs": {"short-wait"},
    "failure/checked_goals": {"never-matches"},
    "failure/error_code_annotation": {"unknown-belief"},
    "failure/goal_variable_failure_continues": {"context-never-true"},
    "failure/inapplicable_handler_drops_intention": {"context-never-true", "narrow-handler"},
    "failure/test_goal_without_plan_no_handler": {"unknown-belief"},
    "failure/warning_inapplicable_handler": {"narrow-handler"},
    "goal_conditions_and_subplans/failing_test_in_a_sub_plan": {"unknown-belief"},
    "goal_conditions_and_subplans/handler_outside_the_scope": {"unknown-belief"},
    "goal_conditions_and_subplans/handlers_of_nested_scopes": {"unknown-belief"},
    "internal_actions/list_rules_of_one_predicate": {"unknown-belief"},
    "namespaces_and_includes/local_namespaces_of_included_files": {"unknown-goal"},
    "namespaces_and_includes/include_without_namespace": {"plan-never-selected"},
    "plan_selection/first_applicable_in_file_order": {"plan-never-selected"},
    "plan_selection/labels_are_found": {"unknown-belief"},
    "plan_selection/priority_annotation_ignored": {"plan-never-selected"},
    "rules_and_queries/precedence_of_and_or_not": {"unknown-belief"},
    "rules_and_queries/rules_raise_no_events": {"event-never-happens"},
    "rules_and_queries/waiting_is_no_condition": {"acting-condition"},
    "terms_and_printing/quoted_atoms_keep_quotes": {"quoted-atom"},
    "time/wait_timeout_elapsed": {"unknown-belief"},
    "unification/plans_are_taken_apart": {"unknown-belief"},
}
"""Cases whose problems are their subject."""


def test_conformance_cases_have_only_the_expected_problems(outcome: Outcome) -> None:
    cases = ROOT / "tests" / "conformance"
    _, output, _ = outcome(str(cases), "--ignore", "singleton-variable", "--format", "json")
    told: dict[str, set[str]] = {}
    for each in json.loads(output)["diagnostics"]:
        path = Path(each["file"]).relative_to(cases)
        if path.parts[0] != "syntax_errors":
            told.setdefault("/".join((path.parts[0], Path(path.parts[1]).stem)), set()).add(each["code"])
    assert told == MEANT


def test_a_program_is_checked_against_its_mapping_files(folder: Path, outcome: Outcome) -> None:
    program = "!go.\n+!go <- navigate_too(1, 2, 0);\n  navigate_to(1, 2);\n  navigate_to(1, 2, 0).\n"
    (folder / "go.asl").write_text(program, encoding="utf-8")
    assert found(outcome, "go.asl") == []
    expected = [("go.asl", line, "unknown-operation") for line in (2, 3)]
    assert found(outcome, "go.asl", "--mapping", "nav2.yaml") == expected
    (folder / "own.yaml").write_text(
        "operations:\n  navigate_too:\n    parameters: [x, y, yaw]\n    publish: goal\n"
        "    type: geometry_msgs/msg/Pose2D\n    fields: {x: $x, y: $y, theta: $yaw}\n",
        encoding="utf-8",
    )
    both = ("--mapping", "nav2.yaml", "--mapping", "own.yaml")
    assert found(outcome, "go.asl", *both) == expected[1:]


def test_mistakes_in_a_mapping_file_are_reported_once_before_those_of_the_program(folder: Path, outcome):
    (folder / "wrong.yaml").write_text("propertys: {}\n", encoding="utf-8")
    assert found(outcome, "good.asl", "--mapping", "wrong.yaml") == [("wrong.yaml", 1, "wrong-mapping")]
    code, output, _ = outcome("good.asl", "--mapping", "nav3.yaml")
    assert code == 1
    assert "mapping file not found: nav3.yaml" in output
    assert "did you mean `nav2.yaml`?" in output


@pytest.mark.parametrize(
    ("expect", "problem", "help"),
    [
        ("expect: {dokced: [true]}", "no artifact of this file has the property `dokced`", "`docked`"),
        ("meanwhile: {no: {bumb: [_]}}", "no artifact of this file has the signal `bumb`", "`bump`"),
        ("expect: {docked: [true]}", "", ""),
        ("expect: {battery: [_, charging]}", "", ""),  # similar to `batteries`, but of turtlebot4.yaml
        ("expect: {gripper: [open]}", "", ""),  # possibly of another artifact
    ],
)
def test_a_misspelt_expectation_is_a_warning(
    folder: Path, outcome: Outcome, expect: str, problem: str, help: str
) -> None:
    (folder / "own.yaml").write_text(
        "properties: {docked: {topic: d, type: std_msgs/msg/Bool, fields: [data]}, batteries: b}\n"
        "signals: {bump: c}\n"
        f"operations:\n  go: {{service: s, {expect}}}\n  back: {{service: s}}\n",
        encoding="utf-8",
    )
    assert found(outcome, "own.yaml") == ([("own.yaml", 4, "unknown-property")] if problem else [])
    code, output, _ = outcome("own.yaml")
    assert code == 0
    assert not problem or (f"warning: {problem}" in output and f"did you mean {help}?" in output)


@pytest.mark.parametrize(
    ("expect", "problems"),
    [("dokced", [("own.yaml", 1, "unknown-property")]), ("docked", []), ("lamp", [])],
)
def test_a_project_has_the_properties_that_its_mappings_expect(
    folder: Path, outcome: Outcome, expect: str, problems: list[tuple[str, int, str]]
) -> None:
    (folder / "own.yaml").write_text(
        f"operations: {{go: {{service: s, expect: {{{expect}: [true]}}}}}}\n", encoding="utf-8"
    )
    (folder / "robot.asl").write_text("!g.\n+!g <- go.\n", encoding="utf-8")
    (folder / "lab.jcm").write_text(
        'mas lab { agent robot : robot.asl mapping: "own.yaml", "turtlebot4.yaml" }', encoding="utf-8"
    )
    assert found(outcome, "lab.jcm") == problems


def test_a_world_file_is_checked_as_a_world(folder: Path, outcome: Outcome) -> None:
    head = "size: [4, 4]\nborder: walls\nrobots:\n"
    (folder / "flat.yaml").write_text(f"{head}  - {{name: r}}\n", encoding="utf-8")
    assert found(outcome, "flat.yaml") == []
    text = head + "  - {name: r, pose: {x: 9}, colour: red}\n  - {namespace: b, pose: {x: 9}}\n"
    (folder / "flat.yaml").write_text(text, encoding="utf-8")
    assert found(outcome, "flat.yaml") == [("flat.yaml", 4, "wrong-world")]
    (folder / "flat.yaml").write_text(text.replace(", colour: red", ""), encoding="utf-8")
    assert found(outcome, "flat.yaml") == [("flat.yaml", 4, "wrong-world"), ("flat.yaml", 5, "wrong-world")]


def test_a_folder_is_checked_with_its_worlds_and_mappings(folder: Path, outcome: Outcome) -> None:
    for name, text in (
        ("flat", "border: walls\nrobots:\n  - {nam: r}\n"),
        ("half", "walls: []\nrooms: {}\nrobtos: [{name: r}]\n"),
        ("robot", "operations:\n  go: {publish: x, typo: y}\n"),
        ("compose", "name: other\nservices: {db: {image: sql}}\n"),
    ):
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    codes = {(file, code) for file, _, code in found(outcome, ".") if str(file).endswith(".yaml")}
    worlds = {("flat.yaml", "wrong-world"), ("half.yaml", "wrong-world")}
    assert codes == {*worlds, ("robot.yaml", "wrong-mapping")}


def test_unsupported_files_are_skipped_next_to_supported_ones(folder: Path, outcome: Outcome) -> None:
    (folder / "a.html").write_text("")
    (folder / "notes.txt").write_text("")
    code, output, errors = outcome("a.html", "good.asl", "notes.txt", "warned.asl")
    assert code == 0
    assert "warned.asl" in output
    assert errors == ("note: skipped unsupported file types: a.html, notes.txt\n2 warnings in 2 files\n")


@pytest.mark.parametrize(
    ("world", "codes"),
    [
        ("patrol", []),
        ("none", []),
        ("patrl", [("p.jcm", 1, "wrong-project")]),
        ("yard.yaml", [("yard.yaml", 1, "wrong-world")]),
    ],
)
def test_the_world_of_a_project_is_checked(
    folder: Path, outcome: Outcome, world: str, codes: list[tuple[str, int, str]]
) -> None:
    (folder / "yard.yaml").write_text("robots: []", encoding="utf-8")
    (folder / "p.jcm").write_text(f'mas p {{ agent good world: "{world}" }}', encoding="utf-8")
    (folder / "p.mas2j").write_text(f'MAS p {{ world: "{world}" agents: good; }}', encoding="utf-8")
    assert found(outcome, "p.jcm") == codes
    as_mas2j = [(str(file).replace(".jcm", ".mas2j"), line, code) for file, line, code in codes]
    assert found(outcome, "p.mas2j") == as_mas2j
