"""Python source being written: indentation, fresh names, and the AgentSpeak line behind each line."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from types import CodeType

from jacaros.asl.source import SourceFile
from jacaros.bdi.fast.generated.line_numbers import compile_text

_READ = re.compile(r" +(v\d+) = deref\(\w+\)")
_SETTLED = re.compile(r"\bv\d+\b")


class Writer:
    """Collects the lines of one piece of generated code.

    Attributes:
        file, origin: file and line of the agent program that the next lines come from.
        files, origins: the same of each line that is written.
        loops: how many loops are open; Python allows 20 nested ones.
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.files: list[SourceFile | None] = []
        self.origins: list[int] = []
        self.file: SourceFile | None = None
        self.origin = 1
        self.depth = 0
        self.loops = 0
        self._count = 0

    def line(self, text: str) -> None:
        """Write one line."""
        self.lines.append("    " * self.depth + text)
        self.files.append(self.file)
        self.origins.append(self.origin)

    def fresh(self, prefix: str = "t") -> str:
        """A local name that is used nowhere else."""
        self._count += 1
        return f"{prefix}{self._count}"

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """A compound statement; the lines written inside belong to it."""
        self.line(head)
        self.depth += 1
        loop = head.startswith(("for ", "while "))
        self.loops += loop
        before = len(self.lines)
        yield
        if len(self.lines) == before:
            self.line("pass")
        self.loops -= loop
        self.depth -= 1

    def prune(self) -> None:
        """Take out the values of variables that are read and then used by nobody."""
        names = Counter(name for line in self.lines for name in _SETTLED.findall(line))
        kept = [
            index
            for index, line in enumerate(self.lines)
            if (read := _READ.fullmatch(line)) is None or names[read[1]] > 1
        ]
        self.lines = [self.lines[i] for i in kept]
        self.files = [self.files[i] for i in kept]
        self.origins = [self.origins[i] for i in kept]

    def text(self) -> str:
        """The source."""
        return "\n".join(self.lines) + "\n"


def compile_all(writers: Iterable[Writer], filename: str) -> CodeType:
    """Python code of several pieces, whose line numbers are those of the agent program *filename*."""
    lines: list[str] = []
    origins = [0]
    for writer in writers:
        lines += writer.lines
        origins += writer.origins
    origins.append(origins[-1])
    return compile_text("\n".join(lines) + "\n", origins, filename)
