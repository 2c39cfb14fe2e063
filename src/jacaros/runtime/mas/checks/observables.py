"""What artifact types give agents: their properties and signals with what is known of the values, and the units of their
operations' parameters.

>>> value_of_words("whole number in percent")
Value(kind='number', options=(), unit='percent', whole=True)
>>> value_of_words("one of free, front").options
('free', 'front')
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

from jacaros.agents.checks.flow import UNKNOWN, Adder, Value
from jacaros.artifacts.env.class_sources import ClassSources
from jacaros.artifacts.env.manual import described_usages, own_classes, usages_in

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

    _Read = Callable[[type], list[tuple[str, Adder]]]

_OPENS: Final = re.compile(r"define_operation|make_artifact|create\(")
"""Code that adds operations at run time."""
_CLOSED: Final = ("jacaros.artifacts.", "jacaros.robots.")
"""Modules whose artifacts have only the operations that their classes declare."""
_NAMES_ITSELF: Final = re.compile(r"\b(?:define_property|signal)\(\s*[^\s\"')]")
"""Code that computes a name."""
_NUMBER: Final = re.compile(
    r"(?P<whole>whole )?number(?: (?:in|of|from) (?P<unit>[\w ]+?))?(?:, \d+ decimals?)?"
)
_SEVERAL: Final = ("...", "Values")
"""Words for any number of values."""
_OPEN_LIST: Final = "..."


class Observables:
    """The properties and signals of artifacts. The source of each class is read once: that is slow."""

    def __init__(self) -> None:
        self._sources = ClassSources()
        self._described = _each_once(_described)
        self._written = _each_once(self._in_code)

    def of(self, types: "Iterable[type[Artifact]]") -> dict[str, list[Adder]] | None:
        """Return the properties and signals of artifacts, by name; None if code computes their names."""
        found: dict[str, list[Adder]] = {}
        for artifact_type in types:
            classes = own_classes(artifact_type)
            if any(map(self._computes_names, classes)):
                return None
            for name, described in self._described(artifact_type):
                found.setdefault(name, []).append(described)
            sizes = {
                (name, size)
                for name, adders in found.items()
                for each in adders
                for size in (each.size, None)
            }
            for name, written in chain.from_iterable(map(self._written, classes)):
                if (name, written.size) not in sizes:  # the description says more
                    found.setdefault(name, []).append(written)
        return found

    def _in_code(self, kind: type) -> list[tuple[str, Adder]]:
        return [(name, _adder("property", usage, "")) for name, usage in usages_in(kind, self._sources)]

    def _computes_names(self, kind: type) -> bool:
        """Return whether the code of a class computes names of properties. Built-in classes declare all of theirs."""
        is_built_in = kind.__module__.startswith("jacaros.")
        return not is_built_in and self._sources.mentions(kind, _NAMES_ITSELF) is not False

    def may_add(self, artifact_type: type) -> bool:
        """Return whether artifacts of a type may define operations, or create other artifacts, at run time."""
        kinds = [each for each in artifact_type.__mro__ if not each.__module__.startswith(_CLOSED)]
        return any(self._sources.mentions(each, _OPENS) is not False for each in kinds if each is not object)


def _each_once(read: "_Read") -> "_Read":
    """Return the function with a memory. It keeps no type: a language server reads those of a project with each edit."""
    known: WeakKeyDictionary[type, list[tuple[str, Adder]]] = WeakKeyDictionary()

    def remembered(kind: type) -> list[tuple[str, Adder]]:
        found = known.get(kind)
        if found is None:
            found = known[kind] = read(kind)
        return found

    return remembered


def parameter_units(types: "Iterable[type[Artifact]]") -> dict[tuple[str, int], Sequence[str]]:
    """Return the units of the parameters of mapped operations; those that differ among artifacts are empty."""
    found: dict[tuple[str, int], Sequence[str]] = {}
    for artifact_type in types:
        for declared in artifact_type.interface.operations:
            words: dict[str, str] = getattr(declared.source, "parameter_words", dict)()
            names = [each.name for each in declared.signature.parameters]
            units = [value_of_words(words.get(name, "")).unit for name in names]
            before = found.setdefault((declared.name, len(names)), units)
            found[declared.name, len(names)] = [
                one if one == other else "" for one, other in zip(before, units, strict=True)
            ]
    return found


def _described(artifact_type: type) -> list[tuple[str, Adder]]:
    return [
        (usage.partition("(")[0], _adder(how, usage, text))
        for how, section in (("property", "Properties"), ("signal", "Signals"))
        for usage, text in described_usages(artifact_type, section)
    ]


def _adder(how: str, usage: str, text: str) -> Adder:
    written = usage.partition("(")[2].rpartition(")")[0]
    names = [each.strip() for each in written.split(",")] if written else []
    if any(name in _SEVERAL for name in names):
        return Adder(how, None, usage=usage)
    return Adder(how, len(names), tuple(_values(names, text)), usage=usage)


def _values(names: Sequence[str], text: str) -> Iterator[Value]:
    """Yield what a description such as ``X: number in metres; Yaw: number in degrees`` says of values."""
    pairs = [part.partition(": ") for part in re.split(r"[;.] ", text.rstrip("."))]
    words = {name.strip(): word for name, _, word in pairs}
    within = ""  # `Ranges1 to Ranges5: number in metres`
    for name in names:
        spans = [each for each in words if each.startswith(f"{name} to ")]
        within = spans[0] if spans else within
        atom = name.strip("'")  # one of the values in the code
        yield (
            Value(options=(atom,))
            if name != atom
            else value_of_words(words.get(name) or words.get(within, ""))
        )
        within = "" if within.endswith(f" to {name}") else within


def value_of_words(words: str) -> Value:
    """Return what the words of a manual say of a value."""
    if (number := _NUMBER.fullmatch(words)) is not None:
        return Value("number", (), number["unit"] or "", number["whole"] is not None)
    if words == "true or false":
        return Value("atom", ("true", "false"))
    if words.startswith("one of "):
        options = tuple(dict.fromkeys(words.removeprefix("one of ").split(", ")))
        return Value("atom", () if _OPEN_LIST in options else options)
    kinds = {"text": "string", "atom": "atom", "list": "list"}
    kind = kinds.get("list" if words.startswith("list of ") else words, "")
    return Value(kind) if kind else UNKNOWN
