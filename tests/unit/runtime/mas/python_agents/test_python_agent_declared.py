"""Python agents in project files: their classes, options and beliefs."""

from pathlib import Path

import pytest
from python_agents_lab import Ran


def test_instances_options_and_beliefs(run: Ran) -> None:
    code = """
class Painter(PythonAgent):
    async def run(self):
        self.print(self.name, " ", self.options["speed"], " ", self.beliefs, " ", self.beliefs[1].arguments)
"""
    expected = ['1 0.5 [home,room(kitchen,2)] ["kitchen",2]', '2 0.5 [home,room(kitchen,2)] ["kitchen",2]']
    mas2j = 'MAS m { agents: painter painter.py [speed=0.5, beliefs="home, room(kitchen, 2)"] #2; }'
    jcm = (
        "mas m { agent painter: painter.py { instances: 2  speed: 0.5\n beliefs: home, room(kitchen, 2)\n } }"
    )
    for files in ({"m_mas2j": mas2j}, {"m_jcm": jcm}):
        result = run(**files, painter_py=code)
        assert [line.partition("painter")[2].partition("painter")[2] for line in result.lines] == [
            each.replace('"kitchen"', "kitchen") for each in expected
        ]
        assert result.errors == []


TWO = """
class PaintBrush(PythonAgent):
    async def run(self):
        self.print("brush")

class Other(PaintBrush):
    async def run(self):
        self.print("other")
"""


def test_the_class_of_several_is_that_with_the_agents_name_or_the_one_that_is_named(run: Ran) -> None:
    for declared in ("paint_brush two.py", "x two.py [class=PaintBrush]", "x two.py agentClass PaintBrush"):
        assert run(m_mas2j=f"MAS m {{ agents: {declared}; }}", two_py=TWO).lines[0][-5:] == "brush"
    for key in ("class", "ag-class"):
        jcm = f"mas m {{ agent x: two.py {{ {key}: Other }} }}"
        assert run(m_jcm=jcm, two_py=TWO).lines == ["[x] other"]


@pytest.mark.parametrize(
    ("code", "agent", "told"),
    [
        ("x = 1", "a a.py", "no subclass of jacaros.PythonAgent in "),
        (TWO, "a a.py", "ambiguous class of agent `a`: "),
        (
            TWO,
            "a a.py",
            "name one of PaintBrush, Other: `[class=...]` in a .mas2j file, `class: ...` in a .jcm file",
        ),
        (TWO, "a a.py [class=Othr]", "did you mean `Other`?"),
        (TWO, "a a.py [class=Xyz]", "it has PaintBrush, Other"),
        (
            "class A(PythonAgent):\n    def run(self): ...",
            "a a.py",
            "a.py:2: TypeError: A.run is not a coroutine: write async def run",
        ),
        ("class A(PythonAgent):\n    def __init__(self): 1/0", "a a.py", "a.py:3, in __init__)"),
        ("class A(PythonAgent:", "a a.py", "a.py:2: "),
        ("import nowhere", "a a.py", "a.py:2: ModuleNotFoundError: No module named 'nowhere'"),
        (TWO, "a b.py", "program of agent `a` not found: b.py"),
        (TWO, "df a.py [class=Other]", "the directory facilitator `df` cannot be"),
    ],
)
def test_errors_in_the_file_are_reported_before_anything_runs(
    tmp_path: Path, code: str, agent: str, told: str, run: Ran
) -> None:
    result = run(m_mas2j=f"MAS m {{\n  agents: {agent};\n}}", a_py=code)
    assert result.exit_code == 1
    assert told in result.errors[0]
    assert result.errors[0].startswith(f"{tmp_path}/m.mas2j:2:1")
    assert result.lines == []


def test_goals_without_effect_are_reported(run: Ran) -> None:
    result = run(
        m_jcm="mas m { agent a: a.py { instances: 2 goals: g  events: discard} }",
        a_py="class A(PythonAgent):\n    pass\n",
    )
    told = [line.partition(": ")[2].partition("\n")[0] for line in result.errors]
    assert told == ["warning: `goals` of agent `a` has no effect: it is a Python agent"]


def test_its_file_may_be_in_a_folder_and_import_others(tmp_path: Path, run: Ran) -> None:
    (tmp_path / "src" / "agt").mkdir(parents=True)
    (tmp_path / "src" / "agt" / "shapes.py").write_text("SIDES = 4\n", encoding="utf-8")
    (tmp_path / "src" / "agt" / "a.py").write_text(
        "import shapes\nfrom jacaros import PythonAgent\nclass A(PythonAgent):\n"
        "    async def run(self):\n        self.print(shapes.SIDES)\n",
        encoding="utf-8",
    )
    assert run(m_mas2j="MAS m { agents: a a.py; b src/agt/a.py; }").of("a") == ["4"]
    assert run(m_mas2j='MAS m { agents: b "src/agt/a.py"; }').lines == ["[b] 4"]


def test_an_artifact_to_focus_may_be_created_later(run: Ran) -> None:
    result = run(
        m_jcm="""mas m {
            agent a: a.py { focus: w.counter, w.other }
            agent bob { join: w }
            workspace w { artifact other: Counter(7) }
        }""",
        a_py="""
class A(PythonAgent):
    async def run(self):
        self.print(self.value("count"))
        await self.until(lambda: self.has_property("count", 5))
        self.print(self.clock.now() % 100)
""",
        bob_asl='!go. +!go <- .wait(1000); makeArtifact(counter, "Counter", [5]).',
    )
    assert result.lines == ["[a] 7", "[a] 1"]
    assert all("error" not in line for line in result.errors)
