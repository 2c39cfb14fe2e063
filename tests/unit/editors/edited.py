"""Programs with a cursor, for tests of what editors show."""

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.artifacts import Artifact, Atom, Out, operation
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Position


class Wheels(Artifact):
    """Drives.

    Properties:
        pose(X, Y, Yaw): where it is. X: number in metres; Y: number in metres; Yaw: number in degrees.

    Signals:
        bump(Side): it has hit something.
    """

    def init(self) -> None:
        """Begin at the origin."""
        self.define_property("pose", 0, 0, 0)

    @operation
    def drive(self, length: float, speed: float) -> None:
        """Drive *length* metres, at *speed* metres per second."""
        self.signal("bump", Atom("left"))

    @operation
    def measure(self, distance: Out) -> None:
        """Measure the distance to a wall."""
        distance.set(1)


def opened(marked: str, name: str = "robot.asl") -> tuple[SourceFile, Position]:
    """Return a text without its cursor, which is written ``‸``, and the cursor's place."""
    before, _, after = marked.partition("‸")
    return SourceFile(name, before + after), Position(
        before.count("\n") + 1, len(before) - before.rfind("\n")
    )


def edited(
    marked: str, *others: tuple[str, str], index: Index | None = None
) -> tuple[Index, SourceFile, Position]:
    """Return the index of a project with an edited program and others, and the cursor."""
    index = Index([Wheels], agents=["guard"]) if index is None else index
    file, at = opened(marked)
    texts = dict(others)
    program, _ = read_program(file, lambda path, _: (path, texts[path]))
    index.put(file.name, program)
    for name, text in others:
        index.put(name, read_program(SourceFile(name, text))[0])
    return index, file, at
