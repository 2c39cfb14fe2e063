"""Python files of projects are read, not run, by commands that only look at a project."""

import json
from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call
from jacaros.runtime.mas.checks.files import check_files

ROOT = Path(__file__).parents[2]

RUNS = "__import__('pathlib').Path('ran').touch()"
HOSTILE = f"""
import jacaros
from dataclasses import dataclass, field
from jacaros import internal_action
from jacaros.artifacts import Artifact, operation

{RUNS}
x = {RUNS}
if {RUNS} or True:
    y: int = {RUNS}
for _ in [{RUNS}]: pass
with open('ran', 'w'): pass
lambda: 0
class Metaclass(type):
    {RUNS}
class Made({RUNS}): pass
class Kept(Artifact, metaclass=Metaclass): pass
@{RUNS}
class Decorated(Artifact): pass
@jacaros.run('other.asl')
def started(): {RUNS}
class Lamp(Artifact):
    {RUNS}
    level = {RUNS}
    other: {RUNS} = {RUNS}
    def init(self, a=({RUNS}), *, b: "{RUNS}" = 1) -> {RUNS}:
        {RUNS}
    @operation(name={RUNS})
    def named(self): ...
class Switch(Artifact):
    level = {RUNS}
    @operation
    def on(self, a: "{RUNS}" = {RUNS}, b: list[{RUNS}] = 3) -> None:
        {RUNS}
@internal_action
def act(a: {RUNS}, b=({RUNS})): {RUNS}
@internal_action({RUNS})
def other(a): {RUNS}
@dataclass
class Record:
    a: int = field(default_factory={RUNS})
"""


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def write(**files: str) -> None:
    for name, text in files.items():
        Path(name.replace("__", ".")).write_text(text, encoding="utf-8")


def findings() -> list[tuple[str, str]]:
    return [(each.code, each.message) for each in check_files([Path("a.asl")]).diagnostics]


@pytest.mark.parametrize(
    "command",
    [
        ("check", "a.asl"),
        ("check", "p.jcm"),
        ("check", "artifacts.py"),
        ("describe", "artifacts.py"),
        ("describe", "Switch"),
        ("describe", "p.jcm"),
    ],
    ids=" ".join,
)
def test_nothing_of_a_project_is_run(command: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    write(artifacts__py=HOSTILE, my__py=HOSTILE)
    write(
        a__asl='!go.\n+!go <- my.act(1, 2); X = my.size(1) + 1; .print(X); makeArtifact("s", "Switch"); on(1, 2).\n'
    )
    write(p__jcm="mas p { agent a : a.asl { ag-class: my.Careful } workspace w { artifact s: Switch() } }")
    call(list(command))
    assert not Path("ran").exists()
    assert "defect" not in capsys.readouterr().err
    Path("artifacts.py").write_text(RUNS, encoding="utf-8")
    Path("my.py").write_text(RUNS, encoding="utf-8")
    call([*command, "--import"])
    assert Path("ran").exists()


def test_what_a_file_declares_is_known_without_running_it() -> None:
    write(
        a__asl='!go.\n+!go <- makeArtifact("l", "Lamp"); on(1); onn(1); my.act(1); my.act;\n'
        "  my.norm(1, 2, N); X = my.sq(2).\n"
    )
    write(
        my__py="""
from jacaros import arithmetic_function, internal_action
@internal_action
def act(a: float): ...
@internal_action("my.norm")
def _(a: float, b: float) -> float: ...
@arithmetic_function()
def sq(*numbers): ...
""",
        artifacts__py="""
from jacaros.artifacts import Artifact, operation
from base import Base
class Lamp(Base):
    def init(self): self.define_property("level", 1)
""",
        base__py="""
from jacaros.artifacts import Artifact, operation
class Base(Artifact):
    @operation
    def on(self, level: float) -> None: ...
""",
    )
    write(p__jcm="mas p { agent a : a.asl }")
    found = [each.message for each in check_files([Path("p.jcm")]).diagnostics]
    assert [each for each in found if "X" not in each and "variable" not in each] == [
        "unknown operation `onn/1`: no artifact of the project has it",
        "internal action `my.act` expects 1 argument, found none",
    ]


def test_names_known_only_at_run_time_give_one_note() -> None:
    write(
        a__asl='!go.\n+!go <- makeArtifact("l", "Lamp"); on(1); my.act(1); X = my.sq(2) + 1; .print(X).\n',
        my__py="for name in ('act', 'sq'):\n    globals()[name] = make(name)\n",
        artifacts__py="from robots import make_class\nLamp = make_class('lamp')\n",
    )
    write(p__jcm="mas p { agent a : a.asl { ag-class: my.Careful } workspace w { artifact s: Lamp() } }")
    found = check_files([Path("p.jcm")]).diagnostics
    assert [(each.severity, each.code) for each in found] == [("note", "not-imported")] * 2
    assert {Path(each.message.split()[2]).name for each in found} == {"my.py", "artifacts.py"}


def test_an_error_in_a_file_is_reported_with_its_line() -> None:
    write(a__asl="!go.\n+!go <- my.act(1).\n", my__py="from jacaros import internal_action\n\ndef act(:\n")
    ((code, message),) = [each for each in findings() if each[0] == "unreadable-file"]
    assert code == "unreadable-file"
    assert message.endswith("my.py:3: invalid syntax")


@pytest.mark.parametrize("project", ["07_shared_robot", "08_parcels"])
def test_the_findings_about_examples_are_those_of_running_their_code(project: str) -> None:
    path = ROOT / "examples" / project
    assert check_files([path]).diagnostics == check_files([path], imports=True).diagnostics


def test_a_description_read_from_the_source_is_that_of_the_class(capsys: pytest.CaptureFixture[str]) -> None:
    write(
        artifacts__py="""
from dataclasses import dataclass
from enum import Enum, auto
from jacaros.artifacts import Artifact, Out, operation
@dataclass
class Pose:
    x: float
    y: float = 1
class Speed(Enum):
    SLOW = auto()
    FAST = auto()
class Navigator(Artifact):
    \"\"\"Goes there.\"\"\"
    def init(self, at: Pose): self.define_property("pose", at)
    @operation(guard="free")
    async def go(self, to: list[Pose], how: Speed, done: Out, *more: int) -> None: "It goes."
    def free(self, *_): return True
"""
    )
    texts = []
    for given in ([], ["--import"]):
        assert call(["describe", "artifacts.py", "--json", *given]) == 0
        texts.append(json.loads(capsys.readouterr().out))
    assert texts[0] == texts[1]
    assert texts[0]["operations"][0]["usage"].startswith("go(to: ")
