"""The magics of ``%load_ext jacaros``: ``%%asl`` for programs, ``%jacaros`` for the system that they make."""

import argparse
import shlex
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from IPython.core.error import UsageError
from IPython.core.interactiveshell import InteractiveShell
from IPython.core.magic import Magics, cell_magic, line_magic, magics_class

from jacaros.artifacts.env.artifact import Artifact
from jacaros.notebook.run import Run
from jacaros.notebook.running import run_programs
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.options import RunOptions

ALONE = "agent"
"""Name of the agent of a cell that names none."""


def load_ipython_extension(shell: InteractiveShell) -> None:
    """Load the magics. Called by ``%load_ext jacaros``."""
    shell.register_magics(AgentMagics(shell))


class _Arguments(argparse.ArgumentParser):
    """Arguments of a magic: an error is one message below the cell, not the end of the kernel."""

    def read(self, line: str) -> argparse.Namespace:
        """Return the arguments of a line.

        Raises:
            UsageError: they are wrong.
        """
        try:
            return self.parse_args(shlex.split(line))
        except ValueError as problem:
            raise UsageError(f"{problem}: {line}") from None

    def error(self, message: str) -> Any:
        raise UsageError(f"{message}\n{self.format_usage()}")


def _with_settings(program: str, description: str) -> _Arguments:
    parser = _Arguments(program, description=description, add_help=False)
    parser.add_argument(
        "--world", help="world file, or the name of a shipped world (default: the world `empty`)"
    )
    parser.add_argument(
        "--mapping",
        action="append",
        default=[],
        dest="mappings",
        help="mapping file of the robot; a lone agent focuses its artifacts",
    )
    parser.add_argument("--faults", help="fault file of the world")
    parser.add_argument("--seed", type=int, default=0, help="seed of the run (default 0)")
    parser.add_argument("--for", type=float, default=60.0, dest="seconds", help="end after so many seconds")
    parser.add_argument("--until-idle", action="store_true", help="end when no agent has anything to do")
    parser.add_argument("--clock", choices=("fast", "real"), default="fast", help="clock of the run")
    return parser


_CELL = _with_settings("%%asl", "Run the program of the cell, or with a name keep it for `%jacaros run`.")
_CELL.add_argument("name", nargs="?", help="name of the agent")
_LINE = _with_settings("%jacaros", "Run the agents that cells have named; `forget` forgets them.")
_LINE.add_argument("do", choices=("run", "forget"))


@magics_class
class AgentMagics(Magics):
    """Programs of cells, and the runs of their agents."""

    def __init__(self, shell: InteractiveShell) -> None:
        super().__init__(shell)
        self._names = shell.user_ns
        self._programs: dict[str, str] = {}
        self._folder = TemporaryDirectory(prefix="jacaros-")
        self._count = 0

    @cell_magic
    def asl(self, line: str, cell: str) -> Run | None:
        """Run an agent program; with a name, keep it for ``%jacaros run``."""
        given = _CELL.read(line)
        if given.name is None:
            return self._run({ALONE: cell}, given)
        self._programs[given.name] = cell
        print(f"{given.name} is ready; `%jacaros run` runs {', '.join(self._programs)}")
        return None

    @line_magic
    def jacaros(self, line: str) -> Run | None:
        """Run the agents of earlier cells, or forget them."""
        given = _LINE.read(line)
        if given.do == "forget":
            self._programs.clear()
            return None
        if not self._programs:
            raise UsageError("no cell has named an agent: begin one with `%%asl NAME`")
        return self._run(self._programs, given)

    def _run(self, programs: dict[str, str], given: argparse.Namespace) -> Run:
        self._count += 1
        options = RunOptions(
            fast=given.clock == "fast",
            world=given.world,
            mappings=given.mappings,
            faults=given.faults,
            seed=given.seed,
            seconds=given.seconds,
            until_idle=given.until_idle,
        )
        file = Path(self._folder.name) / f"run_{self._count}.jsonl"
        try:
            return run_programs(programs, options, self._artifact_types(), file)
        except JacarosError as problem:
            raise UsageError(f"\n{problem}") from None

    def _artifact_types(self) -> list[type[Artifact]]:
        """Return the artifacts that cells define."""
        return [
            each
            for each in self._names.values()
            if isinstance(each, type) and issubclass(each, Artifact) and each.__module__ == "__main__"
        ]
