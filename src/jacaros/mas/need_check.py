"""Check for resources that plans need but no artifact of the project uses: they are probably misspelt."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from jacaros.agents.checks.checker import needs_of
from jacaros.agents.checks.formulas import clauses as clauses_of
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import ByKind
from jacaros.artifacts.env.arbiter import local_name, read_uses
from jacaros.files.texts import close_matches, did_you_mean

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact


def check_needs(programs: Sequence[nodes.Program], types: "Iterable[type[Artifact]]") -> Iterator[Diagnostic]:
    """Return warnings about resources that only one plan names.

    Plans may share a resource that no artifact uses. So if several plans need it, it is reported only if its name is
    similar to that of an artifact's resource.
    """
    known = sorted(set(_used_by(types)))
    if not known:
        return
    found = [each for program in programs for each in needs_of(ByKind(*clauses_of(program)))]
    counts = Counter(name for name, _ in found)
    for name, item in found:
        if local_name(name) in known:
            continue
        close = close_matches(name, known)
        if close or counts[name] == 1:
            listed = f"resources of the project: {', '.join(known)}"
            yield Diagnostic(
                "warning",
                f"unknown resource `{name}`: no artifact of the project uses it",
                item.span,
                did_you_mean(close, listed),
                "unknown-resource",
            )


def _used_by(types: "Iterable[type[Artifact]]") -> Iterator[str]:
    for each in types:
        for table in (each.interface.operations, each.interface.links):
            yield from (name for declared in table for name in declared.uses)
        yield from read_uses(getattr(each, "further_uses", ()))
