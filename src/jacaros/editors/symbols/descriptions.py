"""What a name means, in one line and in Markdown: its signature, its documentation, and where it comes from."""

from collections.abc import Iterable, Iterator
from pathlib import PurePath

from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.terms.functions import ARITIES
from jacaros.editors.symbols.artifact_types import Offered
from jacaros.editors.symbols.docstrings import markdown, usages_in
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Hover, Occurrence, Position, Role, Symbol
from jacaros.editors.symbols.navigation import occurrence_at

_FEW = 5
"""Number of places that are listed."""
_ROLES: tuple[tuple[str, tuple[Role, ...]], ...] = (
    ("fact or rule", ("defines",)),
    ("offered", ("offers",)),
    ("added", ("adds",)),
    ("told", ("tells",)),
    ("removed", ("removes",)),
    ("handled", ("handles",)),
    ("posted", ("calls",)),
    ("asked", ("asks",)),
)

_SIGNS = {"goal": "!", "plan": "@"}


def hover(index: Index, file: SourceFile, at: Position) -> Hover | None:
    """Return what is known of the name at a position; None if there is no name or nothing is known."""
    found = occurrence_at(index, file, at)
    if found is None:
        return None
    text = _text(index, found)
    return Hover(text, found.span) if text else None


def _text(index: Index, found: Occurrence) -> str:
    symbol = found.symbol
    match symbol.kind:
        case "variable":
            return "\n".join(dict.fromkeys(_of_variable(index, found)))
        case "internal action":
            return _about_action(symbol.name, index.actions.get(symbol.name))
    offered = [_signature_of(each) for each in index.offered(symbol)]
    if symbol.kind == "operation":
        return "\n\n---\n\n".join(offered)
    own = [] if offered else [f"```\n{_usage(index, symbol)}\n```", symbol.kind, _comment(index, symbol)]
    parts = ["\n\n---\n\n".join(offered), *own, described(index, symbol)[1]]
    return "\n\n".join(filter(None, parts))


def _usage(index: Index, symbol: Symbol) -> str:
    names = [each or "_" for each in names_of(index, symbol)]
    arguments = f"({', '.join(names)})" if names else ""
    return f"{prefix_of(symbol)}{_SIGNS.get(symbol.kind, '')}{symbol.name}{arguments}"


def _comment(index: Index, symbol: Symbol) -> str:
    """Return the comment above the first fact, rule or plan."""
    clauses = [each.clause for each in index.of(symbol) if each.role in ("defines", "handles")]
    return next(filter(None, map(_comment_above, clauses)), "")


def _of_variable(index: Index, variable: Occurrence) -> Iterator[str]:
    """Say what properties and operations of its clause tell about the values of a variable."""
    for each in index.in_file(variable.span.file.name):
        if each.clause == variable.clause and variable.symbol.name in each.arguments:
            for offered in index.offered(each.symbol):
                for name, argument in zip(each.arguments, offered.arguments, strict=False):
                    if name == variable.symbol.name and argument.meaning:
                        yield f"- {argument.meaning} (`{argument.name}` of `{offered}`)"


def described(index: Index, symbol: Symbol) -> tuple[str, str]:
    """Return one line, and Markdown, about a belief or goal."""
    occurrences = index.of(symbol)
    lines = [*_where(occurrences, symbol), *_sources(index, symbol)]
    files = {PurePath(each.span.file.name).name for each in occurrences}
    return f"{symbol.kind} in {', '.join(sorted(files)[:2])}" if files else symbol.kind, "\n".join(lines)


def _where(occurrences: Iterable[Occurrence], symbol: Symbol) -> Iterator[str]:
    """Say where a belief is added or a goal is handled, with the lines of the programs."""
    found = list(occurrences)
    for what, roles in _ROLES if symbol.kind != "plan" else ():
        places = [_link(each) for each in found if each.role in roles]
        if places:
            more = f" and {len(places) - _FEW} more" if len(places) > _FEW else ""
            yield f"- {what}: {', '.join(places[:_FEW])}{more}"


def _sources(index: Index, symbol: Symbol) -> Iterator[str]:
    """Say which sources a belief can have."""
    if symbol.kind != "belief":
        return
    roles = {each.role for each in index.of(symbol)}
    known = [
        "`percept`" if index.offered(symbol) else "",
        "`self`" if roles & {"defines", "adds"} else "",
        "the sender of a message" if "tells" in roles else "",
        "a caller" if "offers" in roles else "",
    ]
    if any(known):
        yield f"- source: {', '.join(filter(None, known))}"


def _link(occurrence: Occurrence) -> str:
    span = occurrence.span
    return f"{PurePath(span.file.name).name}:{span.line}"


def names_of(index: Index, symbol: Symbol) -> tuple[str, ...]:
    """Return a name for each argument of a belief or goal: that of a variable somewhere, or an empty text."""
    names = [""] * symbol.arity
    for occurrence in index.of(symbol):
        names = [one or other.lstrip("_") for one, other in zip(names, occurrence.arguments, strict=True)]
    return tuple(names)


def prefix_of(symbol: Symbol) -> str:
    """Return the namespace of a belief or goal as written before its name; empty for the default one."""
    return f"{symbol.scope.partition('#')[0]}::" if symbol.scope else ""


def _comment_above(clause: Span) -> str:
    """Return the comment in the lines right above a clause."""
    lines = clause.file.lines
    first = clause.line - 1
    while first > 0 and lines[first - 1].startswith("//"):
        first -= 1
    return "\n".join([each.lstrip("/").strip() for each in lines[first : clause.line - 1]])


def _signature_of(offered: Offered) -> str:
    """Return an operation or property with kinds and units of its values, in several lines of Markdown."""
    values = [f"- `{each.name}`: {each.meaning}" for each in offered.arguments if each.meaning]
    parts = [f"```\n{offered}\n```", f"{offered.how} of `{offered.holder}`", "\n".join(values), offered.text]
    return "\n\n".join(filter(None, parts))


def _about_action(name: str, action: InternalAction | None) -> str:
    """Return the usage, properties and documentation of an internal action or function."""
    if action is None:
        least, most = ARITIES.get(name, (0, 0))
        return f"```\n{name}\n```\n\narithmetic function, {_counted(least, most)}" if name in ARITIES else ""
    doc = action.function.__doc__
    usages = usages_in(doc) or [name]
    maximum = float("inf") if action.maximum is None else action.maximum
    traits = [
        "internal action",
        _counted(action.minimum, maximum),
        "several answers" if action.backtracks else "",
        "not in contexts" if action.body_only else "",
    ]
    text = "\n".join(usages)
    return f"```\n{text}\n```\n\n{', '.join(filter(None, traits))}\n\n{markdown(doc)}"


def _counted(least: float, most: float) -> str:
    if least == most:
        return f"{least:g} argument{'s' * (least != 1)}"
    return f"{least:g} or more arguments" if most == float("inf") else f"{least:g} to {most:g} arguments"
