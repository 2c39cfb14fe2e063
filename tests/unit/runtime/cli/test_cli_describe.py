"""``jacaros describe``: artifact types, files of them, and projects, for people and for programs."""

import json
from pathlib import Path

import pytest
from command_lab import Outcome, Told

COMMAND = ("describe",)


ARTIFACTS = '''
"""Artifacts of a test."""

from jacaros.artifacts import Artifact, Out, link, operation


class Lamp(Artifact):
    """A lamp.

    Properties:
        power(Watts): what it takes.
    """

    ports = ("socket",)

    def init(self, watts: int = 40):
        self.define_property("power", watts)
        self.define_property("lit", False)

    @operation(name="switch", guard="has_power")
    def set_light(self, on: bool, old: Out):
        """Switch it."""
        self.signal("switched", on)

    def has_power(self):
        return True

    @link
    def cut(self):
        """Take its power away."""


class Bare(Artifact):
    pass
'''
LAMP = """\
Lamp
  A lamp.
made with:
  init(watts: an integer (optional))
properties:
  power(Watts)
      what it takes.
  lit(_)
signals:
  switched(on)
operations:
  switch(on: true or false, -old)  [may wait]
      Switch it.
linked operations:
  cut()
      Take its power away.
out ports: socket
"""
BARE = "Bare\nmade with:\n  init()\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    (tmp_path / "empty.py").write_text("from artifacts import Lamp\n", encoding="utf-8")
    (tmp_path / "bob.asl").write_text("!go. +!go <- .print(hi).", encoding="utf-8")
    (tmp_path / "house.jcm").write_text(
        "mas house {\n  agent bob\n  workspace w {\n    artifact lamp: Lamp(60)\n    artifact odd: Lump\n"
        "    artifact b: Blackboard\n  }\n}\n",
        encoding="utf-8",
    )
    return tmp_path


def test_a_type_and_all_types_of_a_file_are_described_without_backquotes(folder: Path, told: Told) -> None:
    assert told("Lamp") == LAMP
    assert told("Lamp", "--project", str(folder)) == LAMP
    assert told("artifacts.py") == f"{LAMP}\n{BARE}"
    said = told("nav2.yaml")
    assert 'such as "robot_1", rate(5)' in said
    assert "`" not in said


def test_a_project_and_a_program_are_described_with_their_types(folder: Path, told: Told) -> None:
    output = told("house.jcm")
    assert "  workspace w\n    artifact lamp: Lamp\n" in output
    assert "    artifact odd: Lump (unknown artifact type `Lump`; did you mean `Lamp`?)\n" in output
    assert f"\n\n{LAMP}\nBlackboard\n  A tuple space" in output
    assert output.endswith(f"\n{BARE}")
    output = told("bob.asl")
    assert "  agent bob: bob.asl\n" in output
    assert LAMP in output


OFFERS = """
{ offer(goal, deliver(parcel(string, "What to bring."), room([kitchen, office]), metres(out(number))),
        doc("Bring a parcel."), role([nurse, user]), at_most(2), when_busy(wait), when_left(cancel), idempotent) }
{ offer(belief, battery(level(number(0, 100)))) }
battery(80).
+!deliver(_, _, 3).
"""
DESCRIBED = """
  agent bob: bob.asl
    offers goal deliver(parcel: string, room: kitchen | office, -> metres: number) to nurse or user\
; 2 at once, lets more wait; cancelled when its caller leaves; idempotent
      Bring a parcel.
      parcel: What to bring.
    offers belief battery(level: number 0..100) to observer
"""


def test_what_agents_offer_is_described(folder: Path, told: Told) -> None:
    (folder / "bob.asl").write_text(OFFERS, encoding="utf-8")
    for what in ("bob.asl", "house.jcm"):
        assert DESCRIBED in told(what)
    goal, belief = json.loads(told("house.jcm", "--json"))["agents"][0]["offers"]
    assert (goal["what"], goal["at_most"], goal["hints"]) == ("goal", 2, ["idempotent"])
    assert goal["arguments"]["properties"]["room"] == {"type": "string", "enum": ["kitchen", "office"]}
    assert belief["form"] == "battery(level: number 0..100)"
    assert list(goal["results"]["properties"]) == ["metres"]
    assert belief["arguments"]["properties"]["level"] == {"type": "number", "minimum": 0, "maximum": 100}
    (folder / "bob.asl").write_text(OFFERS + "+!broken <- .", encoding="utf-8")
    assert DESCRIBED in told("bob.asl")


def test_the_folders_of_a_project_are_searched(folder: Path, told: Told) -> None:
    tools = folder / "src" / "env" / "tools"
    tools.mkdir(parents=True)
    (tools / "lights.py").write_text(ARTIFACTS, encoding="utf-8")
    (folder / "hall.jcm").write_text(
        "mas hall {\n  agent bob\n  workspace w {\n    artifact lamp: tools.Lamp(60)\n    artifact odd: tools.Lomp\n"
        "  }\n}\n",
        encoding="utf-8",
    )
    output = told("hall.jcm")
    assert "    artifact lamp: tools.Lamp\n" in output
    assert "`tools.Lomp`; did you mean `tools.Lamp`" in output
    assert LAMP in output


def test_json_output_is_complete(folder: Path, told: Told) -> None:
    lamp = json.loads(told("Lamp", "--json"))
    assert lamp["type_name"] == "Lamp"
    assert "on: true or false" in lamp["operations"][0]["usage"]
    assert [each["name"] for each in lamp["properties"]] == ["power", "lit"]
    types = [each["type_name"] for each in json.loads(told("artifacts.py", "--json"))]
    assert types == ["Lamp", "Bare"]
    house = json.loads(told("house.jcm", "--json"))
    assert house["agents"][0]["name"] == "bob"
    assert house["workspaces"][0]["artifacts"][0] == {"name": "lamp", "type": "Lamp"}
    assert {each["type_name"] for each in house["types"]} == {"Lamp", "Blackboard", "Bare"}


@pytest.mark.parametrize(
    ("what", "told"),
    [
        ("Lump", "unknown artifact type `Lump`; did you mean `Lamp`?"),
        ("nothing.py", "file not found: `nothing.py`"),
        ("empty.py", "no artifact type in `empty.py`"),
    ],
)
def test_unknown_types_and_files_are_reported(folder: Path, outcome: Outcome, what: str, told: str) -> None:
    code, _, errors = outcome(what)
    assert code == 2
    assert told in errors
