"""What `jacaros check` reports about beliefs that are never added: only certainly misspelt names."""

from pathlib import Path

import pytest

from jacaros.agents.checks.beliefs import is_misspelt
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.checks.files import check_files

ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

class Radar(Artifact):
    def init(self):
        self.define_property("obstacle", 3)

    @operation
    def turn(self):
        self.signal("turned")

class Anything(Artifact):
    def init(self, name: str = "x"):
        self.define_property(name, 3)
"""

MAPPING = """
properties:
  battery: {topic: /battery, type: std_msgs/msg/Float64, fields: [data]}
signals:
  bumped: {topic: /bumper, type: std_msgs/msg/Bool, fields: [data]}
"""

MAKES = '!start. +!start <- makeArtifact("r", "Radar", [], Id); focus(Id). '
REACTS = "+obstacel(D) <- .print(D)."


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    return tmp_path


def warnings(
    folder: Path, program: str, project: str, mappings: tuple[str, ...], code: str
) -> list[Diagnostic]:
    path = folder / "a.asl"
    path.write_text(program, encoding="utf-8")
    if project:
        path = folder / "p.jcm"
        path.write_text(project, encoding="utf-8")
    found = check_files([path], mappings).diagnostics
    assert not [each for each in found if each.severity == "error"]
    return [each for each in found if each.code == code]


def told(folder: Path, program: str, project: str = "", mappings: tuple[str, ...] = ()) -> list[str]:
    """Return the misspelt names of a program, or of its project, with the suggested names."""
    return [
        f"{each.message.split()[1].strip('`')} {(each.help or '').split()[-1].replace('`', '')}"
        for each in warnings(folder, program, project, mappings, "misspelt-belief")
    ]


def never(folder: Path, program: str) -> list[str]:
    """Return the warnings about events that never happen, with the help after a semicolon."""
    found = warnings(folder, program, "", (), "event-never-happens")
    return [f"{each.message.removeprefix('event ')}; {each.help}" for each in found]


@pytest.mark.parametrize(
    "use",
    [
        "+obstacel(D) <- .print(D).",
        "-obstacel(D) <- .print(D).",
        "+!go : obstacel(D) & D < 3 <- .print(D).",
        "+!go : not obstacel(_) <- .print(a).",
        "near :- obstacel(D) & D < 1.",
        "+!go <- ?obstacel(D); .print(D).",
        "+!go <- if (obstacel(D)) { .print(D) }.",
        "+!go <- for (obstacel(D)) { .print(D) }.",
        "+!go <- .count(obstacel(_), N); .print(N).",
        "+!go <- .findall(D, obstacel(D), L); .print(L).",
        "+!go <- .wait({+obstacel(D)}); .print(D).",
        "@p[while(obstacel(D) & D > 1)] +!go <- .print(a).",
        "@p[achieves(not obstacel(D) | D > 1, 500)] +!go <- .print(a).",
        "+!go <- !go[achieves(obstacel(D) & D > 1)].",
        "!go[achieves(not obstacel(_))]. +!go.",
    ],
)
def test_each_place_where_a_property_is_queried(folder: Path, use: str) -> None:
    assert told(folder, f"{MAKES} {use}") == ["obstacel/1 obstacle?"]
    assert told(folder, f"{MAKES} {use}".replace("obstacel", "obstacle")) == []


@pytest.mark.parametrize(
    ("program", "names"),
    [
        (MAKES + "+tunred <- .print(a).", "tunred/0 turned?"),
        ("threshold(3). +!go : treshold(T) <- .print(T).", "treshold/1 threshold?"),
        ("+!go <- +visited(3). +!ask <- ?vistied(X); .print(X).", "vistied/1 visited?"),
        ("close_to(X) :- X < 3. +!go : colse_to(2).", "colse_to/1 close_to?"),
        (
            "+!make(L) <- .member(T, L); makeArtifact(m, T, [], _). threshold(3). +!go : treshold(T) <- .print(T).",
            "treshold/1 threshold?",
        ),
        (
            '{ include("$jacaros/artifacts.asl") } !start. +!start <- !use_artifact("r", "Radar").' + REACTS,
            "obstacel/1 obstacle?",
        ),
        (
            '!start. +!start <- !have(r, "Radar"). +!have(N, T) <- !make(T, N). +!make(T, N) <- makeArtifact(N, T).'
            + REACTS,
            "obstacel/1 obstacle?",
        ),
        ('!have("Radar"). +!have(T) <- makeArtifact(r, T).' + REACTS, "obstacel/1 obstacle?"),
    ],
    ids=[
        *("signal", "initial belief", "note", "rule", "whatever artifacts exist"),
        *("type in a library goal", "type through two goals", "type in a goal"),
    ],
)
def test_each_source_of_a_name_counts(folder: Path, program: str, names: str) -> None:
    assert told(folder, program) == [names]


def test_the_warning_has_a_location_and_a_fix(folder: Path) -> None:
    (folder / "a.asl").write_text(f"{MAKES}\n+obstacel(D) <- .print(D).\n", encoding="utf-8")
    (found,) = check_files([folder / "a.asl"]).diagnostics
    assert found.span is not None
    assert (found.severity, found.span.line, found.span.column) == ("warning", 2, 2)
    assert (found.message, found.help) == ("belief `obstacel/1` is never added", "did you mean `obstacle`?")


def test_a_mapping_file_makes_properties_and_signals(folder: Path) -> None:
    (folder / "robot.yaml").write_text(MAPPING, encoding="utf-8")
    mapped = (str(folder / "robot.yaml"),)
    program = "!s. +!s <- ?batery(X); .print(X). +bumpd(X) <- .print(X)."
    assert told(folder, program, mappings=mapped) == ["batery/1 battery?", "bumpd/1 bumped?"]
    assert told(folder, "!s. +!s <- ?battery(X); .print(X). +bumped(X) <- .print(X).", mappings=mapped) == []


PROJECT = """mas p {
    agent a : a.asl { focus: main.r }
    agent b : b.asl
    workspace main { artifact r: Radar() }
}
"""


def test_what_other_agents_tell_counts_in_a_project(folder: Path) -> None:
    (folder / "b.asl").write_text("!t. +!t <- .send(a, tell, parcel(3)).", encoding="utf-8")
    assert told(folder, "+parcle(X) <- .print(X). +obstacel(D) <- .print(D).", PROJECT) == [
        "parcle/1 parcel?",
        "obstacel/1 obstacle?",
    ]
    assert told(folder, "+parcel(X) <- .print(X). +obstacle(D) <- .print(D).", PROJECT) == []


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("b.asl", "!t. +!t <- .send(a, tell, obstacel(3))."),
        ("b.asl", "!t. +!t <- !say(obstacel). +!say(X) <- .print(X)."),
        ("tool.py", "def tell(agent):\n    agent.believe('obstacel(3)')\n"),
        ("other.asl", "+!t <- .send(a, tell, obstacel(3))."),
        ("robot.yaml", "topics: {obstacel: {topic: /scan}}"),
    ],
)
def test_a_name_that_appears_elsewhere_is_intended(folder: Path, file: str, text: str) -> None:
    (folder / "b.asl").write_text("!t. +!t <- .print(a).", encoding="utf-8")
    program = "+obstacel(D) <- .print(D)."
    assert told(folder, program, PROJECT) == ["obstacel/1 obstacle?"]
    (folder / file).write_text(text, encoding="utf-8")
    assert told(folder, program, PROJECT) == []


@pytest.mark.parametrize(
    "more",
    [
        '+!more <- .include("more.asl").',
        "+!more(B) <- +B.",
        "+!more(P) <- .add_plan(P).",
        "+!more(T) <- makeArtifact(m, T, [], _).",
        '+!more <- makeArtifact(m, "Anything", ["obstacel"], _).',
        '+!more <- makeArtifact(m, "Nothing", [], _).',
        "+!more <- linkWorkspace(far, near, there).",
        "+!more <- put(obstacel(3)).",
        "+!more <- .send(bob, tell, [obstacel(3)]).",
        "+?obstacel(3).",
        '+!tell <- .send(bob, tellHow, "+!see <- .send(alice, tell, obstacel(2)).").',
        "+other::obstacel(D) <- .print(D).",
        "+!more <- .at(3, { +obstacel(3) }).",
    ],
)
def test_nothing_is_reported_where_beliefs_may_come_from_elsewhere(folder: Path, more: str) -> None:
    react = "" if "other::" in more else REACTS
    assert told(folder, f"{MAKES} {react} {more}") == []


def test_nothing_is_reported_for_python_agents_and_user_defined_classes(folder: Path) -> None:
    (folder / "b.asl").write_text("!t. +!t <- .print(a).", encoding="utf-8")
    (folder / "mind.py").write_text(
        "from jacaros import Agent, PythonAgent\nclass Mind(Agent):\n    pass\nclass P(PythonAgent):\n    pass\n",
        encoding="utf-8",
    )
    program = "+obstacel(D) <- .print(D)."
    with_class = PROJECT.replace("{ focus", "{ ag-class: mind.Mind\n focus")
    assert told(folder, program, with_class) == []
    assert told(folder, program, PROJECT.replace("b : b.asl", "b : mind.py { ag-class: mind.P }")) == []


@pytest.mark.parametrize("cases", ["conformance", "conformance_environment"])
def test_realistic_programs_cause_no_warning(cases: str) -> None:
    found = check_files([Path(__file__).parents[3] / cases]).diagnostics
    assert [str(each) for each in found if each.code == "misspelt-belief"] == []


@pytest.mark.parametrize(
    ("written", "meant", "misspelt"),
    [
        ("batery", "battery", True),
        ("obstacel", "obstacle", True),
        ("baterry", "battery", False),
        ("atRom", "atRoom", True),
        ("tasks", "task", False),
        ("parcels", "parcel", False),
        ("room_1", "room_2", False),
        ("pose", "pos", False),
        ("hired", "fired", False),
        ("battery", "battery", False),
        ("pos_y", "pos_x", False),
        ("robot_b", "robot_a", False),
        ("light_in", "light_on", False),
        ("closed", "close", False),
        ("larger", "large", False),
        ("battery_levle", "battery_level", True),
    ],
)
def test_which_names_are_misspelt(written: str, meant: str, misspelt: bool) -> None:
    assert is_misspelt(written, meant) is misspelt


RULE = "low :- battery(B) & B < 20. battery(15). "
LOW = RULE + "+low <- .print(a). "
BY_RULE = (
    "low/0` never happens: `low/0` is the conclusion of a rule; "
    "rules cause no events; react to a belief in the body of the rule: `+battery(B) : low`"
)


@pytest.mark.parametrize(
    ("reacts", "sign"),
    [
        ("+low <- .print(low).", "+"),
        ('+low <- .print("the battery is low").', "+"),
        ("-low <- .print(a).", "-"),
        ("+!go <- .wait({+low}); .print(a).", "+"),
        ("+!go <- .wait(100). { +low <- .print(b). }", "+"),
    ],
)
def test_conclusions_of_rules_make_no_events(folder: Path, reacts: str, sign: str) -> None:
    assert never(folder, RULE + reacts) == ["`" + sign + BY_RULE]


@pytest.mark.parametrize(
    "more",
    [
        "battery(1, 2).",
        "battery(A, B) :- A < B.",
        "+!more <- +battery(1, 2).",
        "+!more(X) <- T =.. [battery, [X, X], []]; put(T).",
        '+!more <- .send(bob, tellHow, "+!t <- .send(alice, tell, battery(1, 2)).").',
        "+!more(T) <- makeArtifact(m, T, [], _).",
    ],
)
def test_another_arity_that_may_be_added_is_not_reported(folder: Path, more: str) -> None:
    expected = 1 if more.startswith("battery(A") else 0  # then it is the conclusion of a rule
    found = never(folder, f"battery(15). +battery(A, B) <- .print(A, B). {more}")
    assert len(found) == expected


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("b.asl", "!t. +!t <- .send(a, tell, low)."),
        ("tool.py", "def tell(agent):\n    agent.believe('low')\n"),
        ("robot.yaml", "topics: {low: {topic: /battery}}"),
        ("run.py", 'agent.perceive("battery(5)")'),
    ],
)
def test_an_event_that_another_file_mentions_may_happen(folder: Path, file: str, text: str) -> None:
    (folder / file).write_text(text, encoding="utf-8")
    program = "!go. +!go <- +battery(5). +battery(B)[source(percept)] <- .print(B)." if "run" in file else LOW
    assert never(folder, program) == []


@pytest.mark.parametrize("use", ["zones(b)", "zones(Z) & .print(Z)", "zones(a, b)", "zones([a])"])
def test_another_form_of_a_word_is_a_name_of_its_own_elsewhere(folder: Path, use: str) -> None:
    assert told(folder, f"zone(a). !go. +!go : {use} <- .print(a).") == []


@pytest.mark.parametrize(
    ("program", "why"),
    [
        (
            "battery(15). +battery(B, _) <- .print(B). +battery(B) <- .print(B).",
            "`+battery/2` never happens: belief `battery/2` is never added; did you mean `battery/1`?",
        ),
        (
            "!go. +!go <- -+battery(5). +battery(B)[source(percept)] <- .print(B).",
            (
                "`+battery/1` never happens: no artifact has `battery`, so its source is never `percept`; "
                "the agent adds it itself: write `[source(self)]`, or omit the source"
            ),
        ),
        (
            MAKES + "+obstacle(D)[source(self)] <- .print(D).",
            (
                "`+obstacle/1` never happens: only artifacts have `obstacle`, so its source is never `self`; "
                "write `[source(percept)]`, or omit the source"
            ),
        ),
    ],
    ids=["another arity", "a note is never a percept", "a property is never a note"],
)
def test_an_event_that_never_happens_is_explained(folder: Path, program: str, why: str) -> None:
    assert never(folder, program) == [why]


@pytest.mark.parametrize(
    "program",
    [
        # A conclusion may also be a belief.
        LOW + "low.",
        LOW + "+!more <- +low.",
        LOW + "+!more <- .send(self, tell, low).",
        LOW + "+!more <- .send(bob, askOne, low, R); .print(R).",
        LOW + "+!more(B) <- +B.",
        LOW + "+!more <- .asserta(low).",
        LOW + "+!more <- put(low).",
        LOW + '+!more <- .term2string(T, "low"); put(T).',
        LOW + "+!more(T) <- makeArtifact(m, T, [], _).",
        LOW + '+!more <- makeArtifact(m, "Anything", ["low"], _).',
        # Properties and signals of artifacts are events.
        MAKES + "obstacle(1, 2). +obstacle(X) <- .print(X).",
        MAKES + "near :- turned & obstacle(1). turned :- near. +turned <- .print(a).",
        # Sources may match.
        MAKES + "+obstacle(D)[source(percept)] <- .print(D).",
        MAKES + "+!note <- +obstacle(1). +obstacle(D)[source(self)] <- .print(D).",
        "!go. +!go <- +battery(5)[source(percept)]. +battery(B)[source(percept)] <- .print(B).",
        "!go. +!go <- +battery(5). +battery(B)[source(self)] <- .print(B).",
        "!go. +!go <- +battery(5). +battery(B)[source(X)] <- .print(B, X).",
        "!go. +!go <- +battery(5); .send(a, tell, battery(6)). +battery(B)[source(percept)] <- .print(B).",
        "+seen(B)[source(percept)] <- .print(B).",
        "!go. +!go <- +battery(5); .add_annot(battery(6), source(percept), X). +battery(B)[source(percept)] <- .print(B).",
    ],
)
def test_an_event_that_may_happen_is_not_reported(folder: Path, program: str) -> None:
    assert never(folder, program) == []
