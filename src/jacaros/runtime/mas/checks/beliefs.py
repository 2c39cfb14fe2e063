"""Check for beliefs that programs use but that are never added: the name is misspelt, the arity differs, or the belief
is the conclusion of a rule, which causes no event.

Beliefs may come from anywhere: other programs, Python code, tests, users. So a name is reported only if the project
certainly adds a similar one, and if it appears nowhere else.
"""

import inspect
import os
import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jacaros.agents.checks.beliefs import Beliefs, beliefs_of, is_fact_of, is_misspelt, source_of
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import parts_of
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.files.texts import did_you_mean, file_bytes

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
    check = _BeliefCheck(found, types, tuple(folders))
    return [*check.misspelt(), *check.never_happening(), *check.from_wrong_source()]


@dataclass(frozen=True)
class _BeliefCheck:
    found: Sequence[Beliefs]
    types: "Callable[[], Sequence[type[Artifact]] | None]"
    folders: tuple[Path, ...]

    @cached_property
    def _said(self) -> set[str]:
        return {word for each in self.found for word in each.said} | _OF_THE_SYSTEM

    @cached_property
    def _observables(self) -> frozenset[str] | None:
        """The properties and signals of all artifacts; None if they are not known, because code computes their names."""
        from jacaros.artifacts.env.manual import described, own_classes, written_properties, written_signals

        types = self.types()
        names: set[str] = set()
        for artifact_type in types or ():
            if any(map(_works_names_out, own_classes(artifact_type))):
                return None
            for section in ("Properties", "Signals"):
                names.update(described(artifact_type, section))
            names.update(written_properties(artifact_type), written_signals(artifact_type))
        return None if types is None else frozenset(names)

    def misspelt(self) -> Iterator[Diagnostic]:
        """Return warnings about names that are nearly those of beliefs that are added."""
        made = {name for each in self.found for name in each.made}
        known = {name for each in self.found for name in each.mentioned} | made | _OF_THE_SYSTEM
        asked: dict[str, list[nodes.Literal]] = {}
        for each in self.found:
            for name, literals in each.asked.items():
                if name not in known:
                    asked.setdefault(name, []).extend(filter(_is_own, literals))
        if asked:
            made |= self._observables or frozenset()
        meant = {}
        for name in [each for each in asked if each not in made]:
            similar = [each for each in made if is_misspelt(name, each)] or self._forms(name, asked[name])
            if similar:
                meant[name] = min(similar)
        only_here = self._only_here({name: asked[name] for name in meant})
        for name in meant:
            for literal in asked[name] if name in only_here else ():
                message = f"belief `{name}/{len(literal.arguments)}` is never added"
                yield Diagnostic("warning", message, literal.span, did_you_mean([meant[name]]), CODE)

    def _forms(self, name: str, asked: Sequence[nodes.Literal]) -> list[str]:
        """Return names that are another form of a word (``zone``, ``zones``) and have a fact that answers the query."""
        return [
            known
            for each in self.found
            for known, facts in each.facts.items()
            if is_slip_of(name, known) and any(is_fact_of(one, fact) for one in asked for fact in facts)
        ]

    def never_happening(self) -> Iterator[Diagnostic]:
        """Return warnings about plans for beliefs that only rules conclude, or that are added only with another arity."""
        made = {key for each in self.found for key in each.made_as}
        mentioned = {key for each in self.found for key in each.mentioned_as} | made
        never: list[tuple[nodes.Literal, Diagnostic]] = []
        for each in self.found:
            for key, events in each.events.items():
                name = key[0]
                if name in self._said or key in mentioned or (name, 0) in mentioned:
                    continue
                other = sorted(size for made_name, size in made if made_name == name)
                rule = each.concluded.get(key)
                if rule is None and (not other or any(key in one.concluded for one in self.found)):
                    continue
                why, help = _why_never(key, rule, other)
                never += [
                    (literal, _never(sign, literal, why, help))
                    for sign, literal in events
                    if _is_own(literal)
                ]
        if not never or (observables := self._observables) is None:
            return
        only_here = self._only_here(_by_name(literal for literal, _ in never), observables)
        yield from (warning for literal, warning in never if literal.functor in only_here)

    def from_wrong_source(self) -> Iterator[Diagnostic]:
        """Return warnings about plans for beliefs from a source that they never have: percepts that only the agent adds,
        and notes that only artifacts publish.
        """
        brought = {key for each in self.found for key in each.brought | set(each.concluded)}
        wrong: list[tuple[str, nodes.Literal, bool]] = []
        for each in self.found:
            for key, events in each.events.items():
                if key in brought or (key[0], 0) in brought or key[0] in self._said:
                    continue
                for sign, literal in events:
                    is_percept = key in each.noted
                    if _is_own(literal) and source_of(literal) == ("percept" if is_percept else "self"):
                        wrong.append((sign, literal, is_percept))
        if not wrong or (observables := self._observables) is None:
            return
        wrong = [each for each in wrong if (each[1].functor in observables) != each[2]]
        certain = observables | self._only_here(_by_name(literal for _, literal, _ in wrong), observables)
        for sign, literal, is_percept in wrong:
            if literal.functor in certain:
                yield _never(sign, literal, *_why_wrong(literal.functor, is_percept))

    def _only_here(
        self, places: Mapping[str, Sequence[nodes.Literal]], without: Container[str] = ()
    ) -> frozenset[str]:
        """Return the names that appear in no file except those of their literals, *without* some names."""
        own = {
            name: {Path(each.span.file.name).resolve() for each in literals if each.span is not None}
            for name, literals in places.items()
            if name not in without
        }
        for number, path in enumerate(_texts(self.folders) if own else ()):
            if number >= _MOST_FILES:
                return frozenset()
            try:
                words = set(_WORD.findall(file_bytes(path).decode(errors="replace")))
            except OSError:
                continue
            for name in words.intersection(own):
                if path.resolve() not in own[name]:
                    del own[name]
        return frozenset(own)


def _by_name(literals: Iterable[nodes.Literal]) -> Mapping[str, Sequence[nodes.Literal]]:
    places: dict[str, list[nodes.Literal]] = {}
    for each in literals:
        places.setdefault(each.functor, []).append(each)
    return places


def _why_never(key: tuple[str, int], rule: nodes.Rule | None, other: Sequence[int]) -> tuple[str, str]:
    name, size = key
    if rule is None:
        return f"belief `{name}/{size}` is never added", did_you_mean(f"{name}/{each}" for each in other)
    asked = next((part for part in parts_of(rule.body) if isinstance(part, nodes.Literal)), None)
    example = "" if asked is None else f": `+{format_term(asked)} : {format_term(rule.head)}`"
    help = f"rules cause no events; react to a belief in the body of the rule{example}"
    return f"`{name}/{size}` is the conclusion of a rule", help


def _why_wrong(name: str, is_percept: bool) -> tuple[str, str]:
    if is_percept:
        help = "the agent adds it itself: write `[source(self)]`, or omit the source"
        return f"no artifact has `{name}`, so its source is never `percept`", help
    help = "write `[source(percept)]`, or omit the source"
    return f"only artifacts have `{name}`, so its source is never `self`", help


def _never(sign: str, literal: nodes.Literal, why: str, help: str) -> Diagnostic:
    message = f"event `{sign}{literal.functor}/{len(literal.arguments)}` never happens: {why}"
    return Diagnostic("warning", message, literal.span, help, NEVER)


def _is_own(literal: nodes.Literal) -> bool:
    """Return whether a literal is in a file of the project, not in a library of JaCaROS."""
    return literal.span is not None and not literal.span.file.name.startswith("$")


def _works_names_out(artifact_class: type) -> bool:
    """Return whether the code of a class computes names of properties. Built-in classes declare all of theirs."""
    if artifact_class.__module__.startswith("jacaros."):
        return False
    try:
        return _NAMES_ITSELF.search(inspect.getsource(artifact_class)) is not None
    except (OSError, TypeError):
        return True


def _texts(folders: Iterable[Path]) -> Iterator[Path]:
    for folder in dict.fromkeys(each.resolve() for each in folders):
        for place, inner, files in os.walk(folder):
            depth = len(Path(place).relative_to(folder).parts)
            inner[:] = sorted(name for name in inner if name[0] not in "._" and depth < _DEEPEST)
            yield from (Path(place, name) for name in sorted(files) if name.endswith(_TEXTS))
