"""What can be written at a position of a program."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.term_parser import PERFORMATIVES
from jacaros.agents.terms.functions import ARITIES
from jacaros.editors.symbols.artifact_types import EVERYWHERE, Offered
from jacaros.editors.symbols.descriptions import described, names_of, prefix_of
from jacaros.editors.symbols.docstrings import markdown, parameters_in, short_unit
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Completion, Kind, Position
from jacaros.editors.symbols.tokens_at import OpenCall, Reading, reading_at

_OF_LABELS: Final = {
    "atomic": "no other intention runs while this plan runs",
    "urgency(${1:10})": "intentions of the greatest urgency run first",
    "needs(${1:wheels})": "runs only while it has the resource",
    "within(${1:5})": "fails after that number of seconds",
    "while(${1:condition})": "fails as soon as the condition does not hold",
    "achieves(${1:condition})": "the condition holds when it has succeeded",
    "cleanup(${1:goal})": "posts the goal at the end, however it ends",
    "all_unifs": "all solutions of the context are options",
    "breakpoint": "the debugger stops here",
}
_OF_GOALS: Final = {
    "within(${1:5})": "fails after that number of seconds",
    "every(${1:1})": "repeats it, each number of seconds",
    "retry(${1:3})": "repeats it that number of times if it fails",
    "achieves(${1:condition})": "the condition holds when it has succeeded",
    "needs(${1:wheels})": "runs only while it has the resource",
}
_OF_BELIEFS: Final = {
    "source(percept)": "it comes from an artifact",
    "source(self)": "the agent added it itself",
    "source(${1:Agent})": "another agent told it",
}
_OF_ACTIONS: Final = {
    'artifact_name("${1:name}")': "the artifact that runs the operation",
    'wsp("${1:workspace}")': "the workspace of the artifact",
    "timeout(${1:1000})": "fails after that number of milliseconds",
}
_STEPS: Final = {
    "if": "if (${1:condition}) {\n    ${2:step}\n}",
    "while": "while (${1:condition}) {\n    ${2:step}\n}",
    "for": "for (${1:condition}) {\n    ${2:step}\n}",
}
_DIRECTIVES: Final = {
    "include": '{ include("${1:file.asl}") }',
    "namespace": "{ begin namespace(${1:name}) }\n$0\n{ end }",
}
_CONTENT: Final[dict[str, Kind]] = {
    **dict.fromkeys(("tell", "untell", "askOne", "askAll", "signal"), "belief"),
    **dict.fromkeys(("achieve", "unachieve"), "goal"),
}
_BEFORE_ANNOTATED: Final = frozenset({"@", "!", "!!", "?", "+", "-", "<-", ";", "&", ":"})
"""Signs that say what an annotated name is."""
_SENDS: Final = {".send": 1, ".broadcast": 0}


def completions(index: Index, file: SourceFile, at: Position) -> list[Completion]:
    """Return what can be written at a position, for the name that begins before it."""
    reading = reading_at(file, at)
    if reading.part == "text":
        return []
    start = reading.prefix.casefold().lstrip(".")
    found: dict[tuple[str, str], Completion] = {}
    for each in _proposals(index, reading):
        if each.label.casefold().lstrip(".").startswith(start):
            found.setdefault((each.label, each.insert), each)  # several artifacts may offer the same
    return list(found.values())


def _proposals(index: Index, reading: Reading) -> Iterator[Completion]:
    inner = reading.calls[-1] if reading.calls else None
    if reading.prefix[:1] == "." or "." in reading.prefix:
        yield from _actions(index, reading)
    elif inner is not None and inner.bracket == "[":
        yield from _annotations(reading)
    elif reading.sign == "@":
        return
    elif inner is not None and inner.bracket == "(" and inner.name:
        yield from _arguments(index, reading, inner)
    else:
        yield from _of_part(index, reading)


def _of_part(index: Index, reading: Reading) -> Iterator[Completion]:
    """Propose names for a step, a condition, an event or the beginning of a clause."""
    sign = reading.sign
    if sign in ("!", "!!") or (reading.triggered in ("+!", "-!", "^!") and reading.part == "trigger"):
        yield from _symbols(index, reading, "goal")
    elif reading.part in ("context", "rule"):
        yield from _conditions(index, reading)
    elif reading.part == "body" and sign in ("<-", ";", "{", "}", "|&|", "|||"):
        yield from _operations(index, reading)
        yield from _keywords(reading, _STEPS)
        yield from _actions(index, reading, rank=2)
    elif reading.part == "body" and sign in ("(", "&", "|", "not", "?"):
        yield from _conditions(index, reading)
    elif reading.part == "body" and sign in ("+", "-", "-+", "++", "--"):
        yield from _symbols(index, reading, "belief")
    elif reading.part == "trigger":
        yield from _events(index, reading)
    elif reading.part == "head" and not sign:
        yield from _symbols(index, reading, "belief")
        yield from _keywords(reading, _DIRECTIVES)
    else:
        yield from _variables(reading)


def _conditions(index: Index, reading: Reading) -> Iterator[Completion]:
    yield from _symbols(index, reading, "belief")
    yield from _properties(index, reading)
    yield from _variables(reading)
    yield from _keywords(reading, {"not": "not "})
    yield from _actions(index, reading, rank=2, conditions=True)


def _events(index: Index, reading: Reading) -> Iterator[Completion]:
    yield from _properties(index, reading, with_signals=True)
    yield from _symbols(index, reading, "belief", rank=1)


def _arguments(index: Index, reading: Reading, call: OpenCall) -> Iterator[Completion]:
    """Propose what fits as an argument of a call."""
    place = _SENDS.get(call.name)
    word = call.words[-1] if call.words else ""
    if place is not None and call.argument == place:
        yield from (_plain(each, "keyword", reading, rank=0) for each in PERFORMATIVES)
    elif place is not None and call.argument == place + 1 and word in _CONTENT:
        yield from _symbols(index, reading, _CONTENT[word])
    elif call.name == ".send" and call.argument == 0:
        yield from (_plain(each, "value", reading, detail="agent") for each in index.agents)
    elif call.name == "makeArtifact" and call.argument == 1:
        yield from (_plain(f'"{each}"', "value", reading, detail="artifact type") for each in index.types())
    elif _asks(index, call):
        yield from _symbols(index, reading, "belief")
        yield from _properties(index, reading)
    yield from _variables(reading)


def _asks(index: Index, call: OpenCall) -> bool:
    """Return whether the argument at the cursor is a condition."""
    action = index.actions.get(call.name)
    return action is not None and (action.condition == call.argument or action.awaits)


def _annotations(reading: Reading) -> Iterator[Completion]:
    for text, meaning in _table_of(reading).items():
        label = text.replace("${1:", "").replace("}", "")
        yield Completion(label, "annotation", text, reading.replaces, meaning)


def _table_of(reading: Reading) -> dict[str, str]:
    """Return the annotations of what is before the bracket: a label, a goal, an action or a belief."""
    signs = [each.kind for each in reading.tokens if each.kind in _BEFORE_ANNOTATED]
    sign = signs[-1] if signs else ""
    if sign == "@":
        return _OF_LABELS
    if reading.part == "body" and sign in ("<-", ";"):
        return _OF_ACTIONS
    return _OF_GOALS if sign in ("!", "!!") and reading.part != "trigger" else _OF_BELIEFS


# Kinds of proposals.


def _symbols(index: Index, reading: Reading, kind: Kind, rank: int = 0) -> Iterator[Completion]:
    written = "".join(each.text for each in reading.tokens[-2:])
    for symbol in index.symbols(kind):
        space = prefix_of(symbol)
        name = symbol.name if written.endswith(space) else f"{space}{symbol.name}"
        occurrences = index.of(symbol)
        if index.offered(symbol) or all(each.span == reading.word_span for each in occurrences):
            continue  # a property, or what is being written
        names = names_of(index, symbol)
        detail, documentation = described(index, symbol)
        yield _call(name, kind, names, reading, detail, documentation, rank)


def _operations(index: Index, reading: Reading) -> Iterator[Completion]:
    for each in index.all_offered():
        if each.how == "operation":
            yield _offered(each, "operation", reading)


def _properties(index: Index, reading: Reading, with_signals: bool = False) -> Iterator[Completion]:
    for each in index.all_offered():
        if each.how == "property" or (with_signals and each.how == "signal"):
            yield _offered(each, "property", reading)


def _offered(each: Offered, kind: str, reading: Reading) -> Completion:
    shown = [f"{one.name}: {short_unit(one.unit)}" if one.unit else one.name for one in each.arguments]
    label = f"{each.name}({', '.join([*shown, *['...'] * each.is_open])})" if shown else each.name
    names = [one.name[:1].upper() + one.name[1:] for one in each.arguments]
    insert = _snippet(each.name, names if kind == "property" else [one.name for one in each.arguments])
    detail, rank = f"{each.how} of {each.holder}", int(each.holder in EVERYWHERE)
    return Completion(label, kind, insert, reading.replaces, detail, each.text, rank)


def _actions(index: Index, reading: Reading, rank: int = 0, conditions: bool = False) -> Iterator[Completion]:
    for name, action in index.actions.items():
        if conditions and action.body_only:
            continue
        names = parameters_in(action.function.__doc__, action.minimum) or ("",) * action.minimum
        text = markdown(action.function.__doc__)
        yield _call(name, "internal action", names, reading, "internal action", text, rank)
    for name, (least, _) in ARITIES.items():
        if name not in index.actions:
            yield _call(name, "internal action", ("",) * int(least), reading, "function", "", rank + 1)


def _variables(reading: Reading) -> Iterator[Completion]:
    yield from (_plain(each, "variable", reading, rank=1) for each in reading.variables)


def _keywords(reading: Reading, words: dict[str, str]) -> Iterator[Completion]:
    for each, insert in words.items():
        yield Completion(each, "keyword", insert, reading.replaces, rank=1)


def _plain(text: str, kind: str, reading: Reading, detail: str = "", rank: int = 0) -> Completion:
    return Completion(text, kind, text.replace("$", r"\$"), reading.replaces, detail, "", rank)


def _call(
    name: str, kind: str, names: Sequence[str], reading: Reading, detail: str, documentation: str, rank: int
) -> Completion:
    shown = [each or "_" for each in names]
    label = f"{name}({', '.join(shown)})" if shown else name
    return Completion(label, kind, _snippet(name, names), reading.replaces, detail, documentation, rank)


def _snippet(name: str, names: Iterable[str]) -> str:
    places = [f"${{{number}:{each or '_'}}}" for number, each in enumerate(names, 1)]
    return f"{name}({', '.join(places)})" if places else name
