"""Beliefs that agents wait or ask for and that nobody makes: the name is misspelt, the number of arguments is another one,
or the belief is the conclusion of a rule, which makes no event.

Beliefs may come from anywhere: other programs, Python code, tests, people.  So a name is reported only if it is one, or
nearly one, that the project makes for certain, and if it appears nowhere else.
"""

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jacaros.asl import nodes
from jacaros.asl.checks.beliefs import Beliefs, beliefs_of, is_fact_of, is_misspelt, source_of
from jacaros.asl.checks.formulas import parts_of
from jacaros.asl.checks.histories import no_history, undeclared_histories
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.formatter import format_term
from jacaros.asl.slips import Slips, is_slip_of
from jacaros.bdi.actions.internal_action import STANDARD
from jacaros.text_files import file_bytes

if TYPE_CHECKING:
    from jacaros.env.artifact import Artifact

CODE: Final = "misspelt-belief"
NEVER: Final = "event-never-happens"

_TEXTS: Final = (".asl", ".py", ".mas2j", ".jcm", ".yaml", ".yml")
"""Files in which a name may stand that becomes a belief."""
_WORD: Final = re.compile(r"\w+")
_MOST_FILES, _DEEPEST = 500, 4
"""A folder with more files is no project: nothing is certain there.  Those in deeper folders are not looked at."""
_NAMES_ITSELF: Final = re.compile(r"\b(?:define_property|signal)\(\s*[^\s\"')]")
"""Code that works a name out."""
_OF_THE_SYSTEM: Final = frozenset(
    {"artifact", "childWsp", "connected", "current_wsp", "focused", "focusing", "joinedWsp", "linkedWsp"}
    | {"parentWsp", "provider", "workspace", "jag_awaking", "jag_shutting_down", "jag_sleeping"}
)
"""Beliefs and events that every run may have."""


def check_beliefs(
    programs: Sequence[nodes.Program],
    types: "Callable[[], Sequence[type[Artifact]] | None]",
    folders: Iterable[Path],
) -> list[Diagnostic]:
    """Warnings about misspelt names of beliefs, and about events of beliefs that never happen.

    Args:
        programs: all that the agents of a project run.
        types: gives the types of all artifacts that there may be, None when they are not known: then only what programs
            make counts.  Asked when it matters.
        folders: of the project; their files are looked through when it matters.
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


def check_histories(
    programs: Sequence[nodes.Program], types: "Callable[[], Sequence[type[Artifact]] | None]"
) -> list[Diagnostic]:
    """Warnings about conditions that ask for the past of beliefs of which neither a program nor an artifact keeps it.

    Args:
        programs: as for `check_beliefs`.
        types: as for `check_beliefs`.
    """
    asked = [literal for program in programs for literal in undeclared_histories(program)]
    known = types() if asked else None
    if known is None:
        return []
    from jacaros.env.property import histories_of  # here: see `_observables`

    kept = {name for each in known for name in histories_of(each)}
    return [no_history(literal) for literal in asked if literal.functor not in kept]


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
    near = Slips(made)
    slips = {
        name: sorted(each for each in near.of(name) if is_misspelt(name, each))
        for name in asked
        if name not in made
    }
    for name in slips:
        slips[name] = slips[name] or _forms(name, asked[name], found)
    slips = {name: meant for name, meant in slips.items() if meant}
    only_here = _only_here({name: asked[name] for name in slips}, folders)
    return [
        _warning(name, slips[name][0], each) for name in slips if name in only_here for each in asked[name]
    ]


def _forms(name: str, asked: Sequence[nodes.Literal], found: Sequence[Beliefs]) -> list[str]:
    """Names that are another form of a word (``zone``, ``zones``) and have a fact that answers what is asked."""
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
    """Warnings about plans for beliefs from a source that they never have: percepts that only the agent notes, and notes
    that only artifacts make."""
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
        help = "the agent notes it itself: write [source(self)], or leave the source out"
    else:
        why = f"only artifacts make `{literal.functor}`, so its source is never `self`"
        help = "write [source(percept)], or leave the source out"
    return Diagnostic("warning", f"the event {sign}{key} never happens: {why}", literal.span, help, NEVER)


def _never_happening(
    found: Sequence[Beliefs], types: "Callable[[], Sequence[type[Artifact]] | None]", folders: Sequence[Path]
) -> list[Diagnostic]:
    """Warnings about plans for events of beliefs that only rules conclude, or that are made with other arguments only."""
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
        example = "" if asked is None else f", as in +{format_term(asked)} : {format_term(rule.head)}"
        why = f"{key} is the conclusion of a rule"
        help = f"conclusions cause no events; react to a belief that the rule asks for{example}"
    else:
        why = f"nobody makes a belief {key}"
        help = f"did you mean {' or '.join(f'{literal.functor}/{size}' for size in other)}?"
    return Diagnostic("warning", f"the event {sign}{key} never happens: {why}", literal.span, help, NEVER)


def _is_own(literal: nodes.Literal) -> bool:
    """Whether it stands in a file of the project, not in a library that comes with the package."""
    return literal.span is not None and not literal.span.file.name.startswith("$")


def _warning(name: str, meant: str, literal: nodes.Literal) -> Diagnostic:
    key = f"{name}/{len(literal.arguments)}"
    return Diagnostic("warning", f"nobody makes a belief {key}", literal.span, f"did you mean {meant}?", CODE)


def _observables(types: "Sequence[type[Artifact]]") -> set[str] | None:
    """Properties and signals of artifacts; None when some of them work names out."""
    from jacaros.env.manual_sources import described, own_classes, written_properties, written_signals

    names: set[str] = set()
    for artifact_type in types:
        if any(map(_works_names_out, own_classes(artifact_type))):
            return None
        for section in ("Properties", "Signals"):
            names.update(described(artifact_type, section))
        names.update(written_properties(artifact_type), written_signals(artifact_type))
    return names


def _works_names_out(artifact_class: type) -> bool:
    """Whether the code of a class makes names of properties that are not written in it; built-in ones tell all theirs."""
    import inspect

    if artifact_class.__module__.startswith("jacaros."):
        return False
    try:
        return _NAMES_ITSELF.search(inspect.getsource(artifact_class)) is not None
    except (OSError, TypeError):
        return True


def _only_here(asked: Mapping[str, Sequence[nodes.Literal]], folders: Iterable[Path]) -> list[str]:
    """Those of the names that stand in no file besides those that ask for them."""
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
    """The files of a project in which a name may stand."""
    for folder in dict.fromkeys(each.resolve() for each in folders):
        for place, inner, files in os.walk(folder):
            depth = len(Path(place).relative_to(folder).parts)
            inner[:] = sorted(name for name in inner if name[0] not in "._" and depth < _DEEPEST)
            yield from (Path(place, name) for name in sorted(files) if name.endswith(_TEXTS))
