"""Check for beliefs that programs use but that are never added, because the name is misspelt.

Beliefs may come from anywhere: other programs, Python code, tests, users. So a name is reported only if the project
certainly adds a similar one, and if it appears nowhere else.
"""

import inspect
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jacaros.agents.checks.beliefs import Beliefs, beliefs_of, is_fact_of, is_misspelt
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.files.texts import did_you_mean, file_bytes

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

CODE: Final = "misspelt-belief"

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
    """Return warnings about misspelt names of beliefs.

    Args:
        programs: all programs of the agents of a project.
        types: returns all artifact types of the project, or None if they are not known; then only programs count. Called on
            demand.
        folders: folders of the project. Their files are searched on demand.
    """
    found = [beliefs_of(program, STANDARD) for program in programs]
    if any(each.is_open for each in found):
        return []
    return list(_BeliefCheck(found, types, tuple(folders)).misspelt())


@dataclass(frozen=True)
class _BeliefCheck:
    found: Sequence[Beliefs]
    types: "Callable[[], Sequence[type[Artifact]] | None]"
    folders: tuple[Path, ...]

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

    def _only_here(self, places: Mapping[str, Sequence[nodes.Literal]]) -> frozenset[str]:
        """Return the names that appear in no file except those of their literals."""
        own = {
            name: {Path(each.span.file.name).resolve() for each in literals if each.span is not None}
            for name, literals in places.items()
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
