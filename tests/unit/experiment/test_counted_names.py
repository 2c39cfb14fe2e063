"""Identifiers, checked by hand-made counts of small sources."""

import gzip
from pathlib import Path

from counting import Counts, Group, ProgramMetrics, measure

AGENT = """\
// A robot that waters plants.
{ include("$jacaros/artifacts.asl") }

tank(5).                       // litres
thirsty(P) :- dry(P) & not watered(P).

!water_all.
!'look around'.

@each[atomic]
+!water_all : thirsty(P) & tank(L)
  <- !use_artifact("arm", "ArtCmdVel");
     ?place(P, X, _);
     ?(tank(L) & L > 0);       // no goal: a condition of two
     move_to(X);
     pour(1);
     pour(2);
     .print("watered");
     -+tank(L - 1);
     !!water_all.

-!water_all <- rest.
+rain(_) <- .drop_all_intentions.
^!water_all[state(suspended)] <- .wait({+rain(_)}); .send(boss, achieve, refill).
+?place(P, 1, 2).
"""


def measured(folder: Path, **texts: str) -> ProgramMetrics:
    """Write files (``NAME__SUFFIX=text``) and count them."""
    for name, text in texts.items():
        (folder / name.replace("__", ".")).write_text(text)
    return measure([folder])[0]


def names(program: ProgramMetrics, group: Group) -> set[str]:
    return {name for file in program.files[group] for name in file.identifiers}


def test_names_of_an_agent_count_once_and_identifiers_are_goals_events_and_operations(tmp_path: Path) -> None:
    program = measured(tmp_path, gardener__asl=AGENT)
    (file,) = program.files[Group.AGENTS]
    goals = {"water_all", "look around", "use_artifact", "place"}
    assert file.identifiers == goals | {"rain"} | {"move_to", "pour", "rest"}
    beliefs, variables = {"tank", "thirsty", "dry", "watered"}, {"P", "L", "X"}
    assert file.names == file.identifiers | beliefs | {"each"} | variables
    assert (program.counts(Group.AGENTS).identifiers, program.counts(Group.AGENTS).names) == (8, 16)


def test_the_names_of_an_included_file_belong_to_it(tmp_path: Path) -> None:
    program = measured(
        tmp_path, a__asl='{ include("b.asl") }\n!go.\n+!go <- !help.\n', b__asl="+!help <- ring.\n"
    )
    assert [(file.path.name, file.identifiers) for file in program.files[Group.AGENTS]] == [
        ("a.asl", {"go", "help"}),
        ("b.asl", {"help", "ring"}),
    ]
    assert program.counts(Group.AGENTS).identifiers == 3, "a name in two files counts once"


PYTHON = '''\
"""A module."""
import math as mathematics
from typing import Self

LIMIT: int = 5

class Pump(object):
    flow: float

    def __init__(self, node, *pipes, speed=1.0, **rest):
        self.node = node
        node.twist.linear.x = speed
        self.table["key"] = 1

    @classmethod
    def made(cls) -> Self:
        first, (second, *others) = 1, (2, 3)
        for _ in range(3):
            total += len([each for each in others])
        with open("f") as file, file:
            pass
        try:
            if (found := mathematics.pi) > LIMIT:
                return lambda angle: angle
        except ValueError as error:
            raise
        match first:
            case [head, *tail] | {"a": head, **tail}:
                print(keyword=head)
            case str() as word:
                pass

async def run(): pass
'''


def test_names_bound_by_python_code_count_once(tmp_path: Path) -> None:
    program = measured(tmp_path, a__asl="!go.\n+!go.\n", artifacts__py=PYTHON)
    functions = {"Pump", "__init__", "made", "run"}
    parameters = {"node", "pipes", "speed", "rest", "angle"}
    variables = {
        *("LIMIT", "flow", "first", "second", "others", "total", "each"),
        *("file", "found", "error", "head", "tail", "word"),
    }
    assert names(program, Group.ARTIFACTS) == functions | parameters | variables | {"x"}
    assert program.counts(Group.ARTIFACTS).identifiers == program.counts(Group.ARTIFACTS).names == 23


MAPPING = """\
artifacts:
  base:
    properties:
      pose: {topic: /odom, fields: [pose.pose.position.x]}
    signals:
      bump: {topic: /bumper, type: std_msgs/msg/Bool, fields: [data]}
    operations:
      turn:
        parameters: [angle, speed]
        publish: /cmd_vel
        type: geometry_msgs/msg/Twist
        fields: {angular.z: $speed, linear.x: $angle}
      stop: {publish: /cmd_vel, type: geometry_msgs/msg/Twist}
"""


def test_a_mapping_file_names_artifacts_and_what_they_offer(tmp_path: Path) -> None:
    program = measured(tmp_path, a__asl="!go.\n+!go.\n", robot__yaml=MAPPING)
    assert names(program, Group.ARTIFACTS) == {"base", "pose", "bump", "turn", "angle", "speed", "stop"}


def test_configuration_names_agents_places_and_things(tmp_path: Path) -> None:
    program = measured(
        tmp_path,
        garden__jcm='mas garden { agent ann : a.asl agent bob : a.asl { instances: 2 } world: "beds.yaml"\n'
        "  workspace shed { artifact clock : Clock } }\n",
        a__asl="!go.\n+!go.\n",
        beds__yaml="name: beds\nrooms: {lawn: {from: [0, 0], to: [1, 1]}}\nrobots: [{name: mower}]\n",
    )
    assert names(program, Group.PROJECTS) == {"garden", "ann", "bob", "shed", "clock"}
    assert names(program, Group.WORLDS) == {"beds", "lawn", "mower"}


def test_a_group_is_compressed_together_and_a_total_adds_groups(tmp_path: Path) -> None:
    texts = {"a.asl": "!go.\n+!go <- move.\n", "b.asl": "!stop.\n+!stop <- move.\n"}
    code = "x = 1\n"
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    program = measured(tmp_path, artifacts__py=code)
    agents = program.counts(Group.AGENTS)
    whole = "".join(texts.values()).encode()
    assert agents == Counts(3, 3, 4, 4, *[len(gzip.compress(whole, 9, mtime=0))] * 2, 2)
    other = len(gzip.compress(code.encode(), 9, mtime=0))
    assert program.total == Counts(4, 4, 5, 5, *[agents.gzip_bytes + other] * 2, 3)
