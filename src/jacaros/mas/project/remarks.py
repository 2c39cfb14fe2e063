"""Diagnostics that are found when the names of a project are resolved."""

from collections.abc import Iterable

from jacaros.agents.language.diagnostics import Diagnostic, Span


class Remarks:
    """Collects the diagnostics of a project. Several instances of an agent report each diagnostic only once."""

    def __init__(self, diagnostics: list[Diagnostic]) -> None:
        self.diagnostics = diagnostics

    def error(self, message: str, span: Span | None, help: str | None = None) -> None:
        self.add(Diagnostic("error", message, span, help))

    def warn(self, message: str, span: Span | None, help: str | None = None) -> None:
        self.add(Diagnostic("warning", message, span, help))

    def add(self, diagnostic: Diagnostic) -> None:
        if diagnostic not in self.diagnostics:
            self.diagnostics.append(diagnostic)

    def repeated(self, names: Iterable[tuple[str, Span | None]], what: str) -> None:
        """Report names that occur twice."""
        seen: dict[str, Span | None] = {}
        for name, span in names:
            if name in seen:
                first = seen[name]
                help = None if first is None else f"the first one is at {first.file.name}:{first.line}"
                self.error(f"duplicate {what} `{name}`", span, help)
            seen.setdefault(name, span)
