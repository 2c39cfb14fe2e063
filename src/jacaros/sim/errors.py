"""What can be wrong with a world file."""

from dataclasses import dataclass

from jacaros.errors import JacarosError


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake: where (line and column count from 1), what, and what to do about it."""

    line: int
    column: int
    message: str
    cure: str = ""


class WorldError(JacarosError):
    """A wrong world file; ``str()`` shows every mistake with its file, line, excerpt and cure.

    Attributes:
        file: name of the file.
        problems: the mistakes, in the order of the lines.
    """

    def __init__(self, file: str, text: str, problems: list[Problem]) -> None:
        self.file = file
        self.problems = sorted(problems, key=lambda problem: (problem.line, problem.column))
        lines = text.splitlines()
        super().__init__("\n".join(_render(file, lines, problem) for problem in self.problems))


def _render(file: str, lines: list[str], problem: Problem) -> str:
    shown = [f"{file}:{problem.line}:{problem.column}: {problem.message}"]
    if 0 < problem.line <= len(lines):
        number = f"{problem.line:>5} | "
        shown.append(number + lines[problem.line - 1])
        shown.append(" " * (len(number) + problem.column - 1) + "^")
    if problem.cure:
        shown.append(f"  cure: {problem.cure}")
    return "\n".join(shown)
