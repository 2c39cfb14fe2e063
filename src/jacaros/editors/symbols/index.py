"""The names of one project: where each occurs, and what its artifacts offer."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import PurePath

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.mind.actions.internal_action import STANDARD, InternalAction
from jacaros.artifacts.env.artifact import Artifact
from jacaros.editors.symbols.artifact_types import Offered, offered_by, standard_offers
from jacaros.editors.symbols.model import Kind, Occurrence, Position, Symbol
from jacaros.editors.symbols.occurrences import declared_in, occurrences_of
from jacaros.robots.registry import BUILT_IN
from jacaros.runtime.mas.checks.observables import Observables


class Index:
    """The occurrences of all names of a project, by symbol and by file.

    Args:
        artifacts: the types of its artifacts, as far as they are known.
        actions: internal actions by name, with those of the project's Python code.
        agents: names of its agents.
        before: an earlier index of the project. The artifact types that it knows are not read again.

    Attributes:
        actions: as given.
        agents: as given.
    """

    def __init__(
        self,
        artifacts: Iterable[type[Artifact]] = (),
        actions: Mapping[str, InternalAction] = STANDARD,
        agents: Sequence[str] = (),
        before: "Index | None" = None,
    ) -> None:
        self.actions, self.agents = actions, agents
        self._observables: Observables = Observables() if before is None else before._observables
        known = {} if before is None else before._types
        self._types: dict[type[Artifact], list[Offered]] = {
            each: known[each] if each in known else offered_by(each, self._observables) for each in artifacts
        }
        self._offered: dict[str, list[Offered]] = {}
        for offered in (*standard_offers(), *(each for found in self._types.values() for each in found)):
            same = self._offered.setdefault(offered.name, [])
            if not any((one.holder, one.arguments) == (offered.holder, offered.arguments) for one in same):
                same.append(offered)
        self._programs: dict[str, list[Occurrence]] = {}
        self._by_symbol: dict[Symbol, list[Occurrence]] | None = None
        self._by_file: dict[str, dict[int, list[Occurrence]]] = {}

    def put(self, name: str, program: nodes.Program) -> None:
        """Add a program with its includes, or replace it."""
        self._programs[name] = list(occurrences_of(program, self.actions, name))
        self._by_symbol = None

    def put_project(self, file: SourceFile) -> None:
        """Add a project file, for the beliefs and goals that it gives its agents, or replace it."""
        self._programs[file.name] = list(declared_in(file))
        self._by_symbol = None

    # Occurrences.

    def of(self, symbol: Symbol) -> list[Occurrence]:
        """Return the occurrences of a symbol, file by file."""
        return self._grouped().get(symbol, [])

    def symbols(self, *kinds: Kind) -> Iterator[Symbol]:
        """Yield the symbols of these kinds."""
        return (symbol for symbol in self._grouped() if symbol.kind in kinds)

    def at(self, file: str, position: Position) -> Occurrence | None:
        """Return the occurrence at a position, or right before it."""
        self._grouped()
        found = self._by_file.get(file, {}).get(position.line, ())
        inside = [each for each in found if each.span.column <= position.column <= each.span.end_column]
        return inside[-1] if inside else None  # of `at` and `X` in `at(X`, the one that begins at the cursor

    def in_file(self, file: str) -> Iterator[Occurrence]:
        """Yield the occurrences in a file."""
        self._grouped()
        for found in self._by_file.get(file, {}).values():
            yield from found

    def files(self) -> Iterator[tuple[SourceFile, list[Occurrence]]]:
        """Yield the programs and included files, as they were read, with their occurrences."""
        self._grouped()
        for name in self._by_file:
            found = list(self.in_file(name))
            if name.endswith(".asl"):
                yield found[0].span.file, found

    def _grouped(self) -> dict[Symbol, list[Occurrence]]:
        if self._by_symbol is None:
            self._by_symbol, self._by_file = {}, {}
            seen: set[tuple[str, int, int]] = set()
            for occurrence in (each for found in self._programs.values() for each in found):
                span = occurrence.span
                place = span.file.name, span.line, span.column
                if place in seen:
                    continue  # in a file that several programs include
                seen.add(place)
                self._by_symbol.setdefault(occurrence.symbol, []).append(occurrence)
                self._by_file.setdefault(span.file.name, {}).setdefault(span.line, []).append(occurrence)
            for lines in self._by_file.values():
                for found in lines.values():
                    found.sort(key=lambda each: each.span.column)
        return self._by_symbol

    # Artifacts.

    def offered(self, symbol: Symbol) -> list[Offered]:
        """Return the operations, or properties and signals, that a symbol may mean."""
        if symbol.kind not in ("operation", "belief"):
            return []
        wants = symbol.kind == "operation"
        found = self._offered.get(symbol.name, [])
        return [each for each in found if (each.how == "operation") == wants and each.takes(symbol.arity)]

    def all_offered(self) -> Iterator[Offered]:
        """Yield everything that artifacts offer."""
        for found in self._offered.values():
            yield from found

    def types(self) -> list[str]:
        """Return the names of artifact types for ``makeArtifact``: the project's, then the built-in ones."""
        return list(dict.fromkeys([*map(_type_name, self._types), *BUILT_IN]))


def _type_name(artifact_type: type[Artifact]) -> str:
    """Return the name of an artifact type in a program; that of a mapped one is its file."""
    mapping = getattr(artifact_type, "mapping", None)
    if mapping is None:
        return artifact_type.__name__
    part = f"#{artifact_type.__name__}" if len(mapping.artifacts) > 1 else ""
    return f"{PurePath(mapping.file).name}{part}"
