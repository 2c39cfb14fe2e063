"""Projects with Python agents, and how to run them."""

from collections.abc import Callable
from pathlib import Path

from jacaros import Literal, PythonAgent
from jacaros.testing import RunResult, run_project

ARTIFACTS = """
from jacaros.artifacts import Artifact, Out, operation


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1):
        self.update_property("count", self.value("count") + by)
        self.signal("tick", self.value("count"))

    @operation
    def read(self, out: Out):
        out.set(self.value("count"))


class Wheels(Artifact):
    def init(self):
        self.define_property("speed", 0.0)

    @operation(name="moveForward")
    async def move_forward(self, metres: float):
        try:
            self.update_property("speed", 1.0)
            await self.sleep(metres)
        finally:
            self.update_property("speed", 0.0)
            self.log("still")
"""


BOTH = """mas m {{
    agent a: a.py {{ focus: w.{0} }}
    agent bob {{ focus: w.{0} }}
    workspace w {{ artifact {0}: {1} }}
}}"""


Ran = Callable[..., RunResult]

TALK = "MAS m { agents: a a.py; bob; }"


def run(folder: Path, *, idle: bool = True, seconds: float | None = 60, **files: str) -> RunResult:
    """Write files (``a_asl`` is a.asl) and run the first until nothing is left to do."""
    (folder / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    paths = []
    for name, text in files.items():
        stem, _, suffix = name.rpartition("_")
        paths.append(folder / f"{stem}.{suffix}")
        head = "from jacaros import OperationFailed, Out, PythonAgent, UnknownAgent, Atom, Literal\n"
        paths[-1].write_text(head + text if suffix == "py" else text, encoding="utf-8")
    return run_project(paths[0], until_idle=idle, seconds=seconds)


def class_a(body: str) -> str:
    """A class with this body, in Python."""
    indented = "\n".join(f"    {line}" for line in body.strip("\n").splitlines())
    return f"class A(PythonAgent):\n{indented}\n"


class Echo(PythonAgent):
    async def run(self) -> None:
        async for message in self.messages():
            if message.performative == "tell":
                self.send(message.sender, "tell", Literal("heard", (message.content.functor,)))
            else:
                raise ValueError(message.performative)
