"""Lines and compressed bytes, checked by hand-made counts of small sources, and by the rule of the thesis."""

import gzip
from pathlib import Path

import pytest

from counting import CountedFile, Group, MetricsError, measure
from counting.sources import agentspeak_comments
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.agents.language.nodes import Program


def counted(folder: Path, name: str, text: str) -> CountedFile:
    """The file with this text in a program with one agent."""
    (folder / "agent.asl").write_text("!go.\n+!go.\n")
    (folder / name).write_bytes(text.encode())
    program = measure([folder])[0]
    return next(file for files in program.files.values() for file in files if file.path.name == name)


AGENT = """\
/* Water the plants.

   Every day. */
!water.  // now

+!water
  <- .print("http://robot.test", " /* nor this */");
     /* a long one
        over two lines */ pour(1);   /* between */ rest.
"""
AGENT_CODE = """\
!water.
+!water
  <- .print("http://robot.test", " /* nor this */");
 pour(1);    rest.
"""


PYTHON = '''\
#!/usr/bin/env python3
"""Über: a module.

With a text.
"""

# A comment.
NAME = "# no comment"  # one
"""About the name."""


class Pump:
    """A pump."""

    TEXT = """
# of a text

its end"""

    def run(self):
        "É"; return [  # two
            1,

            # three
            2,
        ]
'''
PYTHON_CODE = '''\
NAME = "# no comment"
class Pump:
    TEXT = """
# of a text
its end"""
    def run(self):
        ; return [
            1,
            2,
        ]
'''


YAML = """\
# A robot.
properties:
  # where it is
  pose: {topic: /odom, description: "# 1", fields: [pose.pose.position.x]}  # of the base

  bump:
    topic: /bumper
    description: |
      No # comment.

      Text.
    type: std_msgs/msg/Bool
    fields: [data] # last
"""
YAML_CODE = """\
properties:
  pose: {topic: /odom, description: "# 1", fields: [pose.pose.position.x]}
  bump:
    topic: /bumper
    description: |
      No # comment.
      Text.
    type: std_msgs/msg/Bool
    fields: [data]
"""


PROJECT = """\
// A garden.
mas garden {

    /* one
       agent */
    agent ann : agent.asl  // "and" no other
    world: "empty"
}"""
PROJECT_CODE = """\
mas garden {
    agent ann : agent.asl
    world: "empty"
}
"""


@pytest.mark.parametrize(
    ("name", "text", "code", "lines"),
    [
        ("water.asl", AGENT, AGENT_CODE, (9, 4)),
        ("artifacts.py", PYTHON, PYTHON_CODE, (26, 10)),
        ("robot.yaml", YAML, YAML_CODE, (13, 9)),
        ("garden.jcm", PROJECT, PROJECT_CODE, (8, 4)),  # its last line has no line feed
    ],
    ids=["program", "python", "mapping", "project"],
)
def test_code_lines_have_no_comments_docstrings_and_blank_lines(tmp_path, name, text, code, lines) -> None:
    file = counted(tmp_path, name, text)
    assert file.code == code
    assert (file.lines, file.counts.code_lines) == lines


def test_both_sizes_are_those_of_gzip_at_its_highest_level(tmp_path: Path) -> None:
    counts = counted(tmp_path, "water.asl", AGENT).counts
    assert counts.gzip_bytes == len(gzip.compress(AGENT.encode(), 9, mtime=0))
    assert counts.gzip_code_bytes == len(gzip.compress(AGENT_CODE.encode(), 9, mtime=0))


def test_line_ends_of_other_systems_are_recognised(tmp_path: Path) -> None:
    file = counted(tmp_path, "water.asl", AGENT.replace("\n", "\r\n"))
    assert (file.lines, file.code) == (9, AGENT_CODE)
    assert file.counts.gzip_bytes == len(gzip.compress(AGENT.replace("\n", "\r\n").encode(), 9, mtime=0))


EXAMPLES = Path(__file__).parents[3] / "examples"


def plain_count(text: str) -> tuple[int, int]:
    """Physical lines and code lines of a program whose comments are on lines of their own or at the ends of lines."""
    lines = text.splitlines()
    return len(lines), sum(
        bool(line.strip()) and not line.lstrip().startswith(("//", "/*")) for line in lines
    )


@pytest.mark.parametrize("folder", sorted(EXAMPLES.glob("0[1-5]*")), ids=lambda path: str(path.name))
def test_the_examples_have_the_number_of_lines_of_a_plain_count(folder: Path) -> None:
    agents = measure([folder])[0].counts(Group.AGENTS)
    text = (folder / "robot.asl").read_text(encoding="utf-8")
    assert (agents.lines, agents.code_lines) == plain_count(text)


@pytest.mark.parametrize(
    "path", sorted(EXAMPLES.glob("*/*.asl")), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_the_code_lines_of_a_program_are_the_same_program(path: Path) -> None:
    def tree(text: str) -> Program:
        return read_program(SourceFile("a.asl", text), lambda *_: ("included.asl", ""))[0]

    text = path.read_text(encoding="utf-8")
    file = CountedFile(path, b"", text, agentspeak_comments(text))
    assert len(file.code) < len(text)
    assert tree(file.code) == tree(text)


def test_python_with_a_wrong_indent_is_reported(tmp_path: Path) -> None:
    with pytest.raises(MetricsError, match=r"artifacts\.py:1:\d: error: not Python: unexpected indent"):
        counted(tmp_path, "artifacts.py", "  x = 1\n")
