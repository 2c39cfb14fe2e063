"""Beliefs that agents wait or ask for and that nobody makes, because their name is misspelt.

Beliefs may come from anywhere: other programs, Python code, tests, people.  So only a name is told that is nearly one which
the project makes for certain, and that stands nowhere else.
"""

import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jacaros.asl import nodes
from jacaros.asl.checks.beliefs import beliefs_of, is_misspelt
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.spelling import Slips
from jacaros.text_files import file_bytes

if TYPE_CHECKING:
    from jacaros.env.artifact import Artifact

CODE: Final = "misspelt-belief"

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
    """Warnings about misspelt names of beliefs.

    Args:
        programs: all that the agents of a project run.
        types: gives the types of all artifacts that there may be, None when they are not known: then only what programs
            make counts.  Asked when it matters.
        folders: of the project; their files are looked through when it matters.
    """
    found = [beliefs_of(program) for program in programs]
    if any(each.is_open for each in found):
        return []
    made = {name for each in found for name in each.made}
    known = {name for each in found for name in each.mentioned} | made | _OF_THE_SYSTEM
    asked: dict[str, list[nodes.Literal]] = {}
    for each in found:
        for name, literals in each.asked.items():
            if name not in known:
                asked.setdefault(name, []).extend(filter(_is_own, literals))
    if asked:
        made |= _observables(types() or ())
    near = Slips(made)
    slips = {
        name: sorted(each for each in near.of(name) if is_misspelt(name, each))
        for name in asked
        if name not in made
    }
    slips = {name: meant for name, meant in slips.items() if meant}
    if slips:
        slips = _only_here(slips, asked, folders)
    return [_warning(name, meant[0], each) for name, meant in slips.items() for each in asked[name]]


def _is_own(literal: nodes.Literal) -> bool:
    """Whether it stands in a file of the project, not in a library that comes with the package."""
    return literal.span is not None and not literal.span.file.name.startswith("$")


def _warning(name: str, meant: str, literal: nodes.Literal) -> Diagnostic:
    key = f"{name}/{len(literal.arguments)}"
    return Diagnostic("warning", f"nobody makes a belief {key}", literal.span, f"did you mean {meant}?", CODE)


def _observables(types: "Sequence[type[Artifact]]") -> set[str]:
    """Properties and signals of artifacts; none when some of them work names out."""
    from jacaros.env.manual_sources import described, own_classes, written_properties, written_signals

    names: set[str] = set()
    for artifact_type in types:
        if any(map(_works_names_out, own_classes(artifact_type))):
            return set()
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


def _only_here(
    slips: dict[str, list[str]], asked: dict[str, list[nodes.Literal]], folders: Iterable[Path]
) -> dict[str, list[str]]:
    """Those of the names that stand in no file besides those that ask for them."""
    own = {
        name: {Path(each.span.file.name).resolve() for each in asked[name] if each.span is not None}
        for name in slips
    }
    left = dict(slips)
    for number, path in enumerate(_texts(folders)):
        if number >= _MOST_FILES:
            return {}
        try:
            words = set(_WORD.findall(file_bytes(path).decode(errors="replace")))
        except OSError:
            continue
        left = {
            name: meant for name, meant in left.items() if name not in words or path.resolve() in own[name]
        }
    return left


def _texts(folders: Iterable[Path]) -> Iterator[Path]:
    """The files of a project in which a name may stand."""
    for folder in dict.fromkeys(each.resolve() for each in folders):
        for place, inner, files in os.walk(folder):
            depth = len(Path(place).relative_to(folder).parts)
            inner[:] = sorted(name for name in inner if name[0] not in "._" and depth < _DEEPEST)
            yield from (Path(place, name) for name in sorted(files) if name.endswith(_TEXTS))
