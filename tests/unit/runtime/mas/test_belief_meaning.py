"""What `jacaros check` reports about beliefs that nothing adds, and about their arguments, values and units."""

from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.checks.files import check_files

MAPPING = """
properties:
  charge:                                # charge(Percent, Status)
    topic: battery_state
    type: sensor_msgs/msg/BatteryState
    fields: [{path: percentage, unit: percent, round: down}, {path: power_supply_status, as: name}]
  place:                                 # place(X, Y, Yaw): metres and degrees
    topic: odom
    type: nav_msgs/msg/Odometry
    fields:
      - {path: pose.pose.position.x, round: 1}
      - {path: pose.pose.position.y, round: 1}
      - {path: pose.pose.orientation, as: yaw, unit: degrees, round: 0}
  bearing:                               # bearing(Yaw): radians
    topic: odom
    type: nav_msgs/msg/Odometry
    fields: [{path: pose.pose.orientation, as: yaw, round: 2}]

operations:
  drive:                                 # drive(Speed, Turn): m/s, degrees/s
    parameters: [speed, turn]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed, angular.z: {value: $turn, unit: degrees}}
  spin:                                  # spin(Turn): radians/s
    parameters: [turn]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {angular.z: $turn}
  face:                                  # face(Yaw): radians
    parameters: [yaw]
    publish: goal_pose
    type: geometry_msgs/msg/PoseStamped
    fields: {pose.orientation: {value: $yaw, as: yaw}}
"""

CODES = {"unknown-belief", "never-matches", "wrong-unit", "misspelt-belief", "event-never-happens"}


def found(folder: Path, program: str, mapping: bool = False) -> list[Diagnostic]:
    path = folder / "robot.asl"
    path.write_text(program, encoding="utf-8")
    (folder / "rover.yaml").write_text(MAPPING, encoding="utf-8")
    diagnostics = check_files([path], [str(folder / "rover.yaml")] if mapping else []).diagnostics
    assert not [each for each in diagnostics if each.severity == "error"]
    return [each for each in diagnostics if each.code in CODES]


def told(folder: Path, program: str, mapping: bool = False) -> list[str]:
    """Return the codes with what stands at their places."""
    return [f"{each.code} {_marked(each)}" for each in found(folder, program, mapping)]


def _marked(each: Diagnostic) -> str:
    assert each.span is not None
    return each.span.file.lines[each.span.line - 1][each.span.column - 1 : each.span.end_column - 1]


@pytest.mark.parametrize(
    ("program", "place"),
    [
        ("!go. +!go : ready <- .print(a).", "ready"),
        ("!go. +!go <- ?ready; .print(a).", "ready"),
        ("!go. +!go <- .wait(ready); .print(a).", "ready"),
        ("!go. +!go <- .wait({+ready}); .print(a).", "ready"),
        ("!go. +!go <- -ready; .print(a).", "ready"),
        ("+ready <- .print(a).", "ready"),
        ("go :- ready. !go. +!go : go <- .print(a).", "ready"),
        ("!go. +!go <- .send(self, tell, done). +done : ready.", "ready"),
        ("mode(a). !go. +!go : mode(a) & ready <- .print(ready).", "ready"),
        ("mode(ready). !go. +!go : mode(ready) & ready <- .print(a).", "ready"),
        ("zone(a). !go. +!go : zones(a) <- .print(a).", "zones(a)"),
        ("at(1, 2). !go. +!go : at(X) <- .print(X).", "at(X)"),
    ],
)
def test_a_belief_that_nothing_adds_is_unknown(tmp_path: Path, program: str, place: str) -> None:
    assert told(tmp_path, program) == [f"unknown-belief {place}"]


@pytest.mark.parametrize(
    ("program", "help"),
    [
        ("zone(a). !go. +!go : zones(a) <- .print(a).", "did you mean `zone`?"),
        (
            "!go. +!go : ready <- .print(a).",
            "add it in a plan (`+ready`), or at the beginning (`ready.`), or check with its `--mapping FILE`",
        ),
        ("at(1, 2). !go. +!go : at(X) <- .print(X).", "did you mean `at/2`?"),
        (
            "!go. +!go : seen(_, X) <- .print(X).",
            "add it in a plan (`+seen(_, X)`), or at the beginning (`seen(_, X).`), or check with its `--mapping FILE`",
        ),
        ('+!go <- .send(bob, tell, "ready").', "did you mean `ready`?"),
        ('+!go <- .send(bob, tell, "Not ready").', None),
    ],
)
def test_the_help_names_what_is_there(tmp_path: Path, program: str, help: str | None) -> None:
    assert [each.help for each in found(tmp_path, program)] == [help]


@pytest.mark.parametrize(
    "more",
    [
        "ready.",
        "+!more <- +ready.",
        "+!more <- -+ready.",
        "+!more <- .send(self, tell, ready).",
        "+!more <- .send(self, tell, [ready]).",
        "+!more <- .send(bob, askOne, ready).",
        "+!more(B) <- .send(self, tell, B).",
        "+!more(B) <- +B.",
        '+!more <- .term2string(T, "ready"); .print(T).',
        "+!more <- .create_agent(bob).",
        "+!more <- move.",
        "ready :- .random(X) & X > 0.5.",
        "+?ready.",
        "// jacaros: ignore-file unknown-belief",
        "// jacaros: allow-file unknown-belief (the console adds it)",
    ],
)
def test_a_belief_that_may_be_added_is_not_reported(tmp_path: Path, more: str) -> None:
    assert told(tmp_path, f"!go. +!go : ready <- .print(a).\n{more}") == []


def test_a_lone_program_may_get_properties_from_a_mapping(tmp_path: Path) -> None:
    (tmp_path / "rover.yaml").write_text(MAPPING, encoding="utf-8")
    assert told(tmp_path, "+charge(P, _) <- .print(P).") == []  # of the file beside it
    assert told(tmp_path, "+docked(P) <- .print(P).") == []  # of a mapping that comes with JaCaROS
    (found_,) = found(tmp_path, "+docked(P) <- .print(P).", mapping=True)
    assert found_.help == "`turtlebot4.yaml` has it: run and check with `--mapping turtlebot4.yaml`"


@pytest.mark.parametrize(
    ("condition", "message"),
    [
        ("place(X, Y)", "belief `place/2` is never added"),
        (
            "place(x, Y, Z)",
            "`place(x, Y, Z)` never matches: `x` is an atom, but argument 1 of `place/3` has a number in metres",
        ),
        (
            'charge(_, "full")',
            '`"full"` is a string, but',
        ),
        ("charge(_, loading)", "the only values of argument 2"),
        ('charge(B, _) & B == "low"', '`B == "low"` compares a number with a string'),
        ("charge(B, _) & B < 0.2", "`B` is in percent, but `0.2` is in the range 0 to 1"),
        ("place(_, _, Yaw) & Yaw > 1.57", "`Yaw` is in degrees, but `1.57` is in radians"),
        ("bearing(Yaw) & Yaw > 90", "`Yaw` is in radians, but `90` is in degrees"),
    ],
)
def test_values_of_properties_are_known_from_the_mapping(
    tmp_path: Path, condition: str, message: str
) -> None:
    (warning,) = found(tmp_path, f"!go. +!go : {condition} <- .print(a).", mapping=True)
    assert message in warning.message


@pytest.mark.parametrize(
    "condition",
    [
        *("place(X, Y, Z)", "place(0, _, _)", "charge(_, full)", "charge(B, S) & B < 20 & S == full"),
        *("charge(B, _) & B < 1", "place(_, _, Yaw) & Yaw > 1.5", "bearing(Yaw) & Yaw > 1.57"),
        *("bearing(A) & place(_, _, A) & A > 90", "charge(B, _) & B * 0.01 < 0.2"),
    ],
)
def test_values_that_fit_are_not_reported(tmp_path: Path, condition: str) -> None:
    assert told(tmp_path, f"!go. +!go : {condition} <- .print(a).", mapping=True) == []


@pytest.mark.parametrize(
    ("step", "marked"),
    [
        ("?place(_, _, Yaw); face(Yaw)", ["wrong-unit Yaw"]),
        ("?bearing(Yaw); face(Yaw)", []),
        ("?place(_, _, Yaw); face(Yaw * 0.0175)", []),
        ("spin(30)", ["wrong-unit 30"]),
        ("spin(3)", []),
        ("drive(0.2, 30)", []),
        ("?place(_, _, Yaw); +aim(Yaw); !turn", ["wrong-unit A"]),
    ],
)
def test_units_of_parameters_are_those_of_the_values(tmp_path: Path, step: str, marked: list[str]) -> None:
    program = f"!go. +!go <- {step}. +!turn : aim(A) <- face(A)."
    program = program if "!turn" in step else program.partition(" +!turn")[0]
    assert told(tmp_path, program, mapping=True) == marked


@pytest.mark.parametrize(
    ("program", "marked"),
    [
        ('mode("idle"). !go. +!go : mode(idle) <- .print(a).', "idle"),
        ("mode(idle). !go. +!go : mode(3) <- .print(a).", "3"),
        ("!go. +!go <- -+mode(go). +mode(stop) <- .print(a).", "stop"),
        ("!go. +!go <- .send(self, tell, mode(go)). +mode(stop) <- .print(a).", "stop"),
        ("at(a). at(b). !go(c). +!go(P) : at(P) <- .print(P).", "c"),
        ("at(a). at(b). !go(c). +!go(P) : at(P) <- .print(P). +!go(P) <- .print(P); .fail.", "c"),
        ("at(a). !go. +!go <- !to[achieves(at(b))]. +!to.", "b"),
        ('at(a). at(b). !go. +!go <- !to("a"). +!to(P) : at(P) <- .print(P).', '"a"'),
        ('at(a). at(b). at("c"). !go. +!go : at(P) <- .print(P).', '"c"'),
        ('zone(b). at(a). at("b"). !go. +!go : at(P) & zone(P) <- .print(P).', '"b"'),
        ('!go. +!go <- .broadcast(tell, "ready").', '"ready"'),
        ("n(1). !go. +!go <- ?n(N); -+n(N + 1); ?n(a); .print(a).", "a"),
    ],
)
def test_a_value_that_nothing_gives_never_matches(tmp_path: Path, program: str, marked: str) -> None:
    assert told(tmp_path, program) == [f"never-matches {marked}"]


@pytest.mark.parametrize(
    "program",
    [
        "mode(idle). !go. +!go <- ?mode(M); -+mode(M). +mode(stop) <- .print(a).",
        "mode(M) :- .member(M, [a]). !go. +!go : mode(b) <- .print(a).",
        "mode(idle). !go. +!go : not mode(busy) <- .print(a).",
        "mode(idle). !go. +!go <- -mode(busy); .print(a).",
        "mode([1]). !go. +!go : mode([X]) <- .print(X).",
        "mode(a). !go. +!go(X) : mode(X) <- .print(X). +!go <- !go(a).",
        "at(a). !go(c). +!go(P) : at(P) <- .print(P). +!go(P) <- .print(P).",
        'at(a). at("b"). !go. +!go : at(P) <- .print(P).',
        "!go. +!go : not ready <- .print(a).",
        'zone("b"). at(a). at("b"). !go. +!go : at(P) & zone(P) <- .print(P).',
        "+other_publisher(T, N) <- .print(T, N).",
        "p(1). !go. +!go <- for (p(X)) { .print(X) }; X = after; .print(X).",
    ],
)
def test_a_value_that_may_be_given_is_not_reported(tmp_path: Path, program: str) -> None:
    assert told(tmp_path, program) == []


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("!go. +!go <- +visited(1); +vistied(2). +visited(X) <- .print(X).", "misspelt-belief vistied(2)"),
        ("!go. +!go : seen(X) & not seen(2) <- +sene(1); .print(X).", "misspelt-belief sene(1)"),
        ("at(a, 1). at(b, 2, 3). !go. +!go : at(X, Y) <- .print(X, Y).", "unknown-belief at(b, 2, 3)"),
    ],
)
def test_a_belief_that_nothing_reads_is_misspelt(tmp_path: Path, program: str, expected: str) -> None:
    assert told(tmp_path, program) == [expected]


@pytest.mark.parametrize(
    ("program", "reported"),
    [
        ("!go. +!go <- +door(open). +door(Open) <- .print(a).", True),
        ("!go. +!go <- +door(open). +door(Open) <- .print(Open).", False),
        ("!go. +!go <- +door(open). +door(State) <- .print(a).", False),
        ("!go. +!go <- +door(open); +door(shut). +door(Open) <- .print(a).", False),
    ],
)
def test_a_variable_named_as_the_only_value_is_probably_that_value(
    tmp_path: Path, program: str, reported: bool
) -> None:
    (tmp_path / "robot.asl").write_text(program, encoding="utf-8")
    diagnostics = check_files([tmp_path / "robot.asl"]).diagnostics
    help = [each.help for each in diagnostics if each.code == "singleton-variable"]
    assert help == (["did you mean `open`?"] if reported else [])


@pytest.mark.parametrize(
    ("steps", "reported"),
    [
        ("drive(1, 0); ?charge(100, _)", True),
        (".wait(charge(100, _)); ?charge(100, _)", False),
        ("!rest; ?charge(100, _)", False),
        ("?charge(P, _); P == 100", False),
    ],
)
def test_a_test_for_one_measurement_is_noted_unless_the_plan_waits(
    tmp_path: Path, steps: str, reported: bool
) -> None:
    (tmp_path / "rover.yaml").write_text(MAPPING, encoding="utf-8")
    (tmp_path / "robot.asl").write_text(f"!go. +!go <- {steps}. +!rest <- .wait(10).", encoding="utf-8")
    diagnostics = check_files([tmp_path / "robot.asl"], [str(tmp_path / "rover.yaml")]).diagnostics
    assert [each.code for each in diagnostics] == (["unawaited-value"] if reported else [])


@pytest.mark.parametrize(
    ("plans", "reported"),
    [
        ("+!drive(S, T) <- drive(S, T). -!drive(_, _) <- .print(a).", True),
        ("+!drive(S, T) <- drive(S, T).", False),
        ("+!drive(S, T) <- drive(S, T). -!drive(_, _) <- .print(a). +!more <- !drive(0, 1).", False),
    ],
)
def test_an_operation_whose_goal_handles_failure_needs_its_mark(
    tmp_path: Path, plans: str, reported: bool
) -> None:
    (tmp_path / "rover.yaml").write_text(MAPPING, encoding="utf-8")
    (tmp_path / "robot.asl").write_text(f"!go. +!go <- drive(1, 0). {plans}", encoding="utf-8")
    diagnostics = check_files([tmp_path / "robot.asl"], [str(tmp_path / "rover.yaml")]).diagnostics
    assert [each.help for each in diagnostics] == (["did you mean `!drive`?"] if reported else [])


JCM = 'mas m { agent a : robot.asl mapping: "rover.yaml" agent b : b.asl }'


def test_another_agent_adds_it_only_to_its_own_beliefs(tmp_path: Path) -> None:
    (tmp_path / "b.asl").write_text("!b. +!b <- +ready; ?ready.", encoding="utf-8")
    (tmp_path / "robot.asl").write_text("!go. +!go : ready <- .print(a).", encoding="utf-8")
    (tmp_path / "rover.yaml").write_text(MAPPING, encoding="utf-8")
    project = tmp_path / "m.jcm"
    project.write_text(JCM, encoding="utf-8")
    (warning,) = check_files([project]).diagnostics
    assert warning.message == "belief `ready/0` is never added"
    assert "b.asl:1 adds it for its own agent only" in (warning.help or "")
    (tmp_path / "b.asl").write_text("!b. +!b <- +ready; ?ready; .send(a, tell, ready).", encoding="utf-8")
    assert check_files([project]).diagnostics == []


def test_a_program_of_two_projects_may_need_the_beliefs_of_either(tmp_path: Path) -> None:
    (tmp_path / "rover.yaml").write_text(MAPPING, encoding="utf-8")
    (tmp_path / "robot.asl").write_text("+charge(_, full) <- .print(a).", encoding="utf-8")
    (tmp_path / "without.jcm").write_text("mas m { agent a : robot.asl }", encoding="utf-8")
    alone = check_files([tmp_path / "without.jcm"]).diagnostics
    assert [each.code for each in alone] == ["unknown-belief"]
    (tmp_path / "real.jcm").write_text(
        'mas m { agent a : robot.asl mapping: "rover.yaml" }', encoding="utf-8"
    )
    for path in (tmp_path / "without.jcm", tmp_path):
        assert not [each for each in check_files([path]).diagnostics if each.code in CODES]


def test_a_belief_that_another_project_declares_is_added_under_any_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "robot.asl").write_text("!go. +!go : home(X) <- .print(X). +!go.", encoding="utf-8")
    (tmp_path / "without.jcm").write_text("mas m { agent a : robot.asl }", encoding="utf-8")
    declared = "mas m { agent a : robot.asl { beliefs: home(dock) } }"
    (tmp_path / "with.jcm").write_text(declared, encoding="utf-8")
    monkeypatch.chdir(tmp_path.parent)
    for path in (tmp_path, Path(tmp_path.name), Path(tmp_path.name, "without.jcm")):
        assert not [each for each in check_files([path]).diagnostics if each.code in CODES]


@pytest.mark.parametrize(
    ("field", "help"),
    [
        ("{path: percentage, round: down}", "percent"),
        ("{path: percentage, unit: percent, round: down}", ""),
        ("{path: percentage, round: 2}", ""),
    ],
)
def test_a_share_is_not_rounded_to_whole_numbers(tmp_path: Path, field: str, help: str) -> None:
    path = tmp_path / "own.yaml"
    path.write_text(
        "properties:\n  battery:\n    topic: battery_state\n    type: sensor_msgs/msg/BatteryState\n"
        f"    fields: [{field}]\n",
        encoding="utf-8",
    )
    found_ = check_files([path]).diagnostics
    assert [(each.code, each.severity, each.span and each.span.line) for each in found_] == (
        [("wrong-unit", "warning", 5)] if help else []
    )
    assert all(f"`unit: {help}`" in (each.help or "") for each in found_)


@pytest.mark.parametrize(
    "more",
    [
        "+!more <- -busy(_).",
        "+!more <- -+busy(b).",
        "+!more <- .abolish(busy(_)).",
        "+!more(B) <- .abolish(B).",
        "+!more <- .send(self, untell, busy(a)).",
        "+!more <- move.",
    ],
)
def test_an_event_of_a_belief_that_nothing_removes_never_happens(tmp_path: Path, more: str) -> None:
    program = "!go. +!go <- +busy(a). -busy(X) <- .print(X)."
    (reported,) = found(tmp_path, program)
    assert reported.message == "event `-busy/1` never happens: nothing removes `busy`"
    assert reported.help == "remove it, as in `-busy(X)`"
    assert found(tmp_path, f"{program} {more}") == []


def test_the_answer_to_a_question_may_be_a_text(tmp_path: Path) -> None:
    plan = "+!kqml_received(Sender, askOne, name, Asked) <- .send(Sender, tell, {}, Asked)."
    assert found(tmp_path, plan.format('"Maria dos Santos"')) == []


def test_properties_that_a_subclass_renames_are_known(tmp_path: Path) -> None:
    made = '!go. +!go <- makeArtifact("wheels", "ArtCmdVelMuxAndOdometry", [], Id); focus(Id).'
    assert told(tmp_path, f"{made} +odom_cmd_vel_mux(X, _, _) <- .print(X).") == []
    assert told(tmp_path, f"{made} +odom_cmd_vel_mx(X, _, _) <- .print(X).") == [
        "unknown-belief odom_cmd_vel_mx(X, _, _)"
    ]
