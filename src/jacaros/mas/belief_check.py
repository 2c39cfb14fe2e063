"""Check for beliefs that programs use but that are never added: the name is misspelt, the arity differs, or the belief
is the conclusion of a rule, which causes no event.

Beliefs may come from anywhere: other programs, Python code, tests, users. So a name is reported only if the project
certainly adds a similar one, and if it appears nowhere else.
"""

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jacaros.agents.checks.beliefs import Beliefs, beliefs_of, is_fact_of, is_misspelt, source_of
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import parts_of
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.files.texts import did_you_mean, file_bytes

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

CODE: Final = "misspelt-belief"
NEVER: Final = "event-never-happens"

_TEXTS: Final = (".asl", ".py", ".mas2j", ".jcm", ".yaml", ".yml")
"""Kinds of files that may contain the name of a belief."""
_WORD: Final = re.compile(r"\w+")
_MOST_FILES, _DEEPEST = 500, 4
"""A folder with more files is not a project, so nothing is certain there. Files in deeper folders are ignored."""
_NAMES_ITSELF: Final = re.compile(r"\b(?:define_property|signal)\(\s*[^\s\"')]")
"""Code that computes a name."""
_OF_THE_SYSTEM: Final = frozenset(
    {"artifact", "childWsp", "connected", "current_wsp", "focused", "focusing", "joinedWsp", "linkedWsp"}
    | {"parentWsp", "provider", "workspace", "jag_awaking", "jag_shutting_down", "jag_sleeping"}
)
"""Beliefs and events that may occur in every run."""


def check_beliefs(
    programs: Sequence[nodes.Program],
    types: "Callable[[], Sequence[type[Artifact]] | None]",
    folders: Iterable[Path],
) -> list[Diagnostic]:
    """Return warnings about misspelt names of beliefs, and about events of beliefs that never happen.

    Args:
        programs: all programs of the agents of a project.
        types: returns all artifact types of the project, or None if they are not known; then only programs count. Called on
            demand.
        folders: folders of the project. Their files are searched on demand.
    """
    found = [beliefs_of(program, STANDARD) for program in programs]
    if any(each.is_open for each in found):
        return []
    folders = tuple(folders)
    return [
        *_misspelt(found, types, folders),
        *_never_happening(found, types, folders),
        *_from_wrong_source(found, types, folders),
    ]


def _misspelt(
    found: Sequence[Beliefs], types: "Callable[[], Sequence[type[Artifact]] | None]", folders: Sequence[Path]
) -> list[Diagnostic]:
    made = {name for each in found for name in each.made}
    known = {name for each in found for name in each.mentioned} | made | _OF_THE_SYSTEM
    asked: dict[str, list[nodes.Literal]] = {}
    for each in found:
        for name, literals in each.asked.items():
            if name not in known:
                asked.setdefault(name, []).extend(filter(_is_own, literals))
    if asked:
        made |= _observables(types() or ()) or set()
    slips = {
        name: sorted(each for each in made if is_misspelt(name, each)) for name in asked if name not in made
    }
    for name in slips:
        slips[name] = slips[name] or _forms(name, asked[name], found)
    slips = {name: meant for name, meant in slips.items() if meant}
    only_here = _only_here({name: asked[name] for name in slips}, folders)
    return [
        _warning(name, slips[name][0], each) for name in slips if name in only_here for each in asked[name]
    ]


def _forms(name: str, asked: Sequence[nodes.Literal], found: Sequence[Beliefs]) -> list[str]:
    """Return names that are another form of a word (``zone``, ``zones``) and have a fact that answers the query."""
    return sorted(
        {
            known
            for each in found
            for known, facts in each.facts.items()
            if is_slip_of(name, known) and any(is_fact_of(one, fact) for one in asked for fact in facts)
        }
    )


def _from_wrong_source(
    found: Sequence[Beliefs], types: "Callable[[], Sequence[type[Artifact]] | None]", folders: Sequence[Path]
) -> list[Diagnostic]:
    """Return warnings about plans for beliefs from a source that they never have: percepts that only the agent adds, and
    notes that only artifacts publish.
    """
    brought = {key for each in found for key in each.brought | set(each.concluded)}
    said = {word for each in found for word in each.said} | _OF_THE_SYSTEM
    wrong: list[tuple[str, nodes.Literal, bool]] = []
    for each in found:
        for key, events in each.events.items():
            if key in brought or (key[0], 0) in brought or key[0] in said:
                continue
            for sign, literal in filter(lambda event: _is_own(event[1]), events):
                source = source_of(literal)
                if source == "percept" and key in each.noted:
                    wrong.append((sign, literal, True))
                elif source == "self" and key not in each.noted:
                    wrong.append((sign, literal, False))
    existing = types() if wrong else None
    observables = None if existing is None else _observables(existing)
    if observables is None:
        return []
    wrong = [each for each in wrong if (each[1].functor in observables) != each[2]]
    places: dict[str, list[nodes.Literal]] = {}
    for _, literal, _ in wrong:
        places.setdefault(literal.functor, []).append(literal)
    only_here = _only_here({name: each for name, each in places.items() if name not in observables}, folders)
    certain = {*only_here, *observables}
    return [_wrong_source(*each) for each in wrong if each[1].functor in certain]


def _wrong_source(sign: str, literal: nodes.Literal, is_percept: bool) -> Diagnostic:
    key = f"{literal.functor}/{len(literal.arguments)}"
    if is_percept:
        why = f"no artifact has `{literal.functor}`, so its source is never `percept`"
        help = "the agent adds it itself: write `[source(self)]`, or omit the source"
    else:
        why = f"only artifacts have `{literal.functor}`, so its source is never `self`"
        help = "write `[source(percept)]`, or omit the source"
    return Diagnostic("warning", f"event `{sign}{key}` never happens: {why}", literal.span, help, NEVER)


def _never_happening(
    found: Sequence[Beliefs], types: "Callable[[], Sequence[type[Artifact]] | None]", folders: Sequence[Path]
) -> list[Diagnostic]:
    """Return warnings about plans for beliefs that only rules conclude, or that are added only with another arity."""
    made = {key for each in found for key in each.made_as}
    mentioned = {key for each in found for key in each.mentioned_as} | made
    said = {word for each in found for word in each.said} | _OF_THE_SYSTEM
    warnings: dict[str, list[Diagnostic]] = {}
    places: dict[str, list[nodes.Literal]] = {}
    for each in found:
        for key, events in each.events.items():
            name = key[0]
            if name in said or key in mentioned or (name, 0) in mentioned:
                continue
            other = sorted(size for made_name, size in made if made_name == name)
            rule = each.concluded.get(key)
            if rule is None and (not other or any(key in one.concluded for one in found)):
                continue
            for sign, literal in events:
                if _is_own(literal):
                    places.setdefault(name, []).append(literal)
                    warnings.setdefault(name, []).append(_never(sign, literal, rule, other))
    if not warnings:
        return []
    existing = types()
    observables = None if existing is None else _observables(existing)
    if observables is None:
        return []
    places = {name: literals for name, literals in places.items() if name not in observables}
    return [warning for name in _only_here(places, folders) for warning in warnings[name]]


def _never(sign: str, literal: nodes.Literal, rule: nodes.Rule | None, other: Sequence[int]) -> Diagnostic:
    key = f"{literal.functor}/{len(literal.arguments)}"
    if rule is not None:
        asked = next((part for part in parts_of(rule.body) if isinstance(part, nodes.Literal)), None)
        example = "" if asked is None else f": `+{format_term(asked)} : {format_term(rule.head)}`"
        why = f"`{key}` is the conclusion of a rule"
        help = f"rules cause no events; react to a belief in the body of the rule{example}"
    else:
        why = f"belief `{key}` is never added"
        help = did_you_mean(f"{literal.functor}/{size}" for size in other)
    return Diagnostic("warning", f"event `{sign}{key}` never happens: {why}", literal.span, help, NEVER)


def _is_own(literal: nodes.Literal) -> bool:
    """Return whether a literal is in a file of the project, not in a library of JaCaROS."""
    return literal.span is not None and not literal.span.file.name.startswith("$")


def _warning(name: str, meant: str, literal: nodes.Literal) -> Diagnostic:
    key = f"{name}/{len(literal.arguments)}"
    return Diagnostic("warning", f"belief `{key}` is never added", literal.span, did_you_mean([meant]), CODE)


def _observables(types: "Sequence[type[Artifact]]") -> set[str] | None:
    """Return the properties and signals of artifacts; None if some of them compute names."""
    from jacaros.artifacts.env.manual import described, own_classes, written_properties, written_signals

    names: set[str] = set()
    for artifact_type in types:
        if any(map(_works_names_out, own_classes(artifact_type))):
            return None
        for section in ("Properties", "Signals"):
            names.update(described(artifact_type, section))
        names.update(written_properties(artifact_type), written_signals(artifact_type))
    return names


def _works_names_out(artifact_class: type) -> bool:
    """Return whether the code of a class computes names of properties. Built-in classes declare all of theirs."""
    import inspect

    if artifact_class.__module__.startswith("jacaros."):
        return False
    try:
        return _NAMES_ITSELF.search(inspect.getsource(artifact_class)) is not None
    except (OSError, TypeError):
        return True


def _only_here(asked: Mapping[str, Sequence[nodes.Literal]], folders: Iterable[Path]) -> list[str]:
    """Return the names that appear in no file except those that query them."""
    if not asked:
        return []
    own = {
        name: {Path(each.span.file.name).resolve() for each in literals if each.span is not None}
        for name, literals in asked.items()
    }
    left = list(asked)
    for number, path in enumerate(_texts(folders)):
        if number >= _MOST_FILES:
            return []
        try:
            words = set(_WORD.findall(file_bytes(path).decode(errors="replace")))
        except OSError:
            continue
        left = [name for name in left if name not in words or path.resolve() in own[name]]
    return left


def _texts(folders: Iterable[Path]) -> Iterator[Path]:
    """Return the files of a project in which a name may appear."""
    for folder in dict.fromkeys(each.resolve() for each in folders):
        for place, inner, files in os.walk(folder):
            depth = len(Path(place).relative_to(folder).parts)
            inner[:] = sorted(name for name in inner if name[0] not in "._" and depth < _DEEPEST)
            yield from (Path(place, name) for name in sorted(files) if name.endswith(_TEXTS))
