"""What is found wrong in a project when its names are resolved."""

from collections.abc import Iterable

from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.slips import close_matches
from jacaros.asl.source import Span


class Remarks:
    """Collects the diagnostics of a project, each once, also when several instances of an agent lead to it."""

    def __init__(self, diagnostics: list[Diagnostic]) -> None:
        self.diagnostics = diagnostics

    def error(self, message: str, span: Span | None, help: str | None = None) -> None:
        """Record an error."""
        self.add(Diagnostic("error", message, span, help))

    def warn(self, message: str, span: Span | None, help: str | None = None) -> None:
        """Record a warning."""
        self.add(Diagnostic("warning", message, span, help))

    def add(self, diagnostic: Diagnostic) -> None:
        """Record a diagnostic."""
        if diagnostic not in self.diagnostics:
            self.diagnostics.append(diagnostic)

    def repeated(self, names: Iterable[tuple[str, Span | None]], what: str) -> None:
        """Blame names that occur twice."""
        seen: dict[str, Span | None] = {}
        for name, span in names:
            if name in seen:
                first = seen[name]
                help = None if first is None else f"the first is in {first.file.name}, line {first.line}"
                self.error(f"two {what} have the name '{name}'", span, help)
            seen.setdefault(name, span)


def meant(name: str, known: Iterable[str]) -> str | None:
    """A suggestion of the known name that is most like *name*."""
    close = close_matches(name, sorted(known))
    return f"did you mean '{close[0]}'?" if close else None
