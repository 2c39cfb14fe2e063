"""Python source being written: indentation, fresh names, and the AgentSpeak line behind each line."""

import ast
from collections.abc import Iterator
from contextlib import contextmanager
from types import CodeType


class Writer:
    """Collects the lines of one piece of generated code.

    Attributes:
        origin: line of the agent program that the next lines come from.
        loops: how many loops are open; Python allows 20 nested ones.
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.origins: list[int] = []
        self.origin = 1
        self.depth = 0
        self.loops = 0
        self._count = 0

    def line(self, text: str) -> None:
        """Write one line."""
        self.lines.append("    " * self.depth + text)
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

    def text(self) -> str:
        """The source."""
        return "\n".join(self.lines) + "\n"

    def compile(self, filename: str) -> CodeType:
        """Python code whose line numbers are those of the agent program *filename*."""
        tree = ast.parse(self.text())
        for node in ast.walk(tree):
            if isinstance(node, (ast.expr, ast.stmt, ast.excepthandler, ast.arg)):
                node.lineno = self.origins[node.lineno - 1]
                node.end_lineno = node.lineno
                node.col_offset = node.end_col_offset = 0
        return compile(tree, filename, "exec")
