"""Check what a project means by its beliefs: who adds those that programs use, with which arguments and values.

Beliefs may come from anywhere: other programs, Python code, tests, users. So a belief is reported only if the whole project
is known, and if its name appears nowhere else. A misspelt name is reported more often: a similar belief is certainly added.
"""

import inspect
import os
import re
from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jacaros.agents.checks.beliefs import (
    as_written,
    capital_atoms,
    comparisons,
    is_misspelt,
    mismatches,
    mixed_facts,
    mixed_units,
    told_texts,
    unawaited,
    unmet_goals,
)
from jacaros.agents.checks.flow import ANY, Adder, Flow, ProgramFlow, Reader, flows_of, is_own, source_of
from jacaros.agents.checks.formulas import Key
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import parts_of
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.files import texts as file_texts
from jacaros.runtime.files.texts import close_matches, did_you_mean, file_bytes
from jacaros.runtime.mas.checks.artifacts import lacks_actions, shipped_with
from jacaros.runtime.mas.checks.observables import Observables, parameter_units

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

MISSPELT: Final = "misspelt-belief"
NEVER: Final = "event-never-happens"
UNKNOWN: Final = "unknown-belief"

_TEXTS: Final = (".asl", ".py", ".yaml", ".yml")
"""Kinds of files that may contain the name of a belief."""
_WORD: Final = re.compile(r"\w+")
_GIVES: Final = re.compile(
    r"\b(?:tell|tellHow|signal|believe\w*|perceive\w*|\w+_belief|define_property|PythonAgent)\b"
)
"""What other programs and Python files need in order to give agents beliefs."""
MAPPINGS: Final = (".yaml", ".yml")
_MOST_FILES, _DEEPEST = 500, 4
"""A folder with more files is not a project, so nothing is certain there. Files in deeper folders are ignored."""
_OF_THE_SYSTEM: Final = frozenset(
    {"artifact", "childWsp", "connected", "current_wsp", "focused", "focusing", "joinedWsp", "linkedWsp"}
    | {"parentWsp", "provider", "workspace", "jag_awaking", "jag_shutting_down", "jag_sleeping"}
)
"""Beliefs and events that may occur in every run."""


@dataclass(frozen=True)
class Whole:
    """A project, or a lone program.

    Attributes:
        programs: the different programs of its agents.
        types: the types of its artifacts; None: not known.
        reading: reads the properties and signals of artifact types.
    """

    programs: Sequence[nodes.Program]
    types: "Sequence[type[Artifact]] | None"
    reading: Observables = field(default_factory=Observables)

    @cached_property
    def observables(self) -> dict[str, list[Adder]] | None:
        """The properties and signals of its artifacts; None: not known."""
        return None if self.types is None else self.reading.of(self.types)

    @cached_property
    def flows(self) -> list[ProgramFlow]:
        """Where each program has its beliefs from."""
        return flows_of(self.programs, STANDARD, self.observables)

    def with_others(self, others: "Sequence[Whole]") -> "Whole":
        """Return one project with the programs of others after its own."""
        wholes = (self, *others)
        programs = [program for each in wholes for program in each.programs]
        kinds = dict.fromkeys(kind for each in wholes for kind in each.types or ())
        is_known = all(each.types is not None for each in wholes)
        return Whole(programs, list(kinds) if is_known else None, self.reading)


@dataclass(frozen=True)
class Surroundings:
    """What is around a project.

    Attributes:
        folders: searched for names on demand.
        files: files whose content is known, which are not searched.
        others: returns other projects that run the same programs; None: not known. Called on demand.
        is_lone: there is only one program, which may be run with mapping files that are not given.
        is_partial: other agents of the project are written in Python, and may add any beliefs.
    """

    folders: tuple[Path, ...] = ()
    files: Set[Path] = frozenset()
    others: Callable[[], Sequence[Whole] | None] = lambda: ()
    is_lone: bool = False
    is_partial: bool = False


def check_beliefs(whole: Whole, around: Surroundings) -> list[Diagnostic]:
    """Return warnings about beliefs that programs use and nothing adds, and about their values."""
    check = _BeliefCheck(whole, around)
    if not list(check.findings(frozenset())):
        return []
    # Only if there is something to report, other projects and other files are read.
    others = around.others()
    if others is None:
        return []
    types = [each for one in (whole, *others) for each in one.types or ()]
    elsewhere = words_elsewhere(around.folders, around.files | set(_sources(types)), around.is_lone)
    if others:
        around = replace(around, is_lone=False)
        check = _BeliefCheck(whole.with_others(others), around, len(whole.programs))
    own = {file for flow in check.flows for file in flow.files}  # the others are found under other paths
    found = () if elsewhere is None else check.findings(elsewhere)
    return [each for each in found if each.span is None or each.span.file.name in own]


class _BeliefCheck:
    """The findings about a project, or about its first programs only."""

    def __init__(self, whole: Whole, around: Surroundings, count: int | None = None) -> None:
        self._is_lone, self._is_partial = around.is_lone, around.is_partial
        programs, types, flows = whole.programs, whole.types or (), whole.flows
        self._flow = Flow(flows, whole.observables or {})
        self.flows = flows[:count]
        self._knows_artifacts = whole.observables is not None
        self._programs = programs
        self._is_closed = (
            self._knows_artifacts
            and not around.is_partial
            and not any(each.tells_unseen for each in flows)
            and not lacks_actions(programs, types, whole.reading)
        )
        self._units = parameter_units(types) if self._is_closed else {}
        self._misspelt = _misspelt_adders(flows, self._flow.observables)
        self._mentioned = {key for each in flows for key in each.mentioned}
        self._removed = {name for each in flows for name in each.removed}
        self._reported: set[Key] = set()

    def findings(self, elsewhere: frozenset[str]) -> Iterator[Diagnostic]:
        """Return the findings about beliefs that do not appear *elsewhere*."""
        if self._flow.is_open:
            return
        self._reported.clear()
        said = [each.spelled if self._is_closed else each.said for each in self._flow.programs]
        doubtful = elsewhere.union(_OF_THE_SYSTEM, *said)
        yield from self._never_read(doubtful)
        for program, flow in zip(self._programs, self.flows, strict=False):
            adders = self._flow.adders(flow)
            yield from (*mixed_facts(flow), *told_texts(flow))
            for reader in () if self._is_partial else flow.readers:
                if is_own(reader.literal) and reader.key[0] not in doubtful:
                    yield from self._of_reader(reader, adders)
            if self._is_closed:
                composed = {name for name, size in self._mentioned if size}.union(*said)
                here = {name: each for name, each in adders.items() if name not in composed}
                certain = {name: each for name, each in here.items() if name not in doubtful}
                yield from (*mismatches(flow, certain), *unmet_goals(program, certain))
                yield from (*unawaited(program, certain), *capital_atoms(flow, certain))
                # Whatever else adds a belief, it does so in the same units.
                yield from (*comparisons(flow, here), *mixed_units(flow, here, self._units))

    def _of_reader(self, reader: Reader, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
        """Return a warning about a belief that is never added, or never with this source or arity."""
        (name, size), literal = reader.key, reader.literal
        if not self._mentioned.isdisjoint([(name, size), (name, 0), (name, ANY)]):
            return
        # A plan for a test goal causes no event, but shows that the name is meant.
        is_event = reader.how == "event"
        known = [each for each in adders.get(name, ()) if not is_event or each.how != "rule"]
        same = [each for each in known if each.size in (None, size)]
        rules = [each for each in adders.get(name, ()) if each.how == "rule" and each.size == size]
        if same:
            if is_event and self._knows_artifacts:
                yield from _from_wrong_source(reader, [*same, *rules])
            if reader.sign == "-" and self._keeps(name, same):
                yield _never(
                    reader, f"nothing removes `{name}`", f"remove it, as in `-{as_written(literal)}`"
                )
        elif rules and self._knows_artifacts:
            yield _never(reader, *_of_rule(reader, rules[0]))
        elif known and self._knows_artifacts:
            usages = [each.usage or f"{name}/{each.size}" for each in known if each.size is not None]
            help, why = did_you_mean(sorted(dict.fromkeys(usages))), f"belief `{name}/{size}` is never added"
            if is_event:
                yield _never(reader, why, help)
            elif self._is_closed:
                yield problem(UNKNOWN, why, literal.span, help)
        elif not known:
            yield from self._never_added(reader, adders)

    def _keeps(self, name: str, adders: Sequence[Adder]) -> bool:
        """Return whether agents have a belief from their own programs, and no program removes or replaces it."""
        is_own = all(each.how in ("fact", "step", "message") for each in adders)
        return self._is_closed and is_own and self._removed.isdisjoint(("", name))

    def _never_added(self, reader: Reader, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
        (name, size), literal = reader.key, reader.literal
        if any(name.endswith(f"_{each}") for each in self._flow.observables):
            return  # some properties begin with the name of the robot
        similar = [each for each in adders if is_misspelt(name, each)]
        message = f"belief `{name}/{size}` is never added"
        if any(meant == name for meant, _ in self._misspelt.values()):
            return  # the belief that is added is misspelt
        if similar:
            yield problem(MISSPELT, message, literal.span, did_you_mean([min(similar)]))
        elif self._is_closed and not reader.denied and reader.key not in self._reported:
            self._reported.add(reader.key)  # nothing is right about the other places either
            shipped = next((path.name for path in shipped_with(name)), "")
            if self._is_lone and (shipped or _is_built_in(name)):
                return  # it is run with that artifact
            private = [each for flow in self._flow.programs for each in flow.adders.get(name, ())]
            near = _to_be_told(private[0]) if private else did_you_mean(close_matches(name, adders))
            rule = f"write a rule: `{as_written(literal)} :- ...`" if reader.how == "question" else ""
            yield problem(UNKNOWN, message, literal.span, near or rule or self._to_be_added(literal, shipped))

    def _to_be_added(self, literal: nodes.Literal, shipped: str) -> str:
        if shipped:
            return f"`{shipped}` has it: run and check with `--mapping {shipped}`"
        written = as_written(nodes.replace(literal, annotations=None))
        mapped = ", or check with its `--mapping FILE`" if self._is_lone else ""
        return f"add it in a plan (`+{written}`), or at the beginning (`{written}.`){mapped}"

    def _never_read(self, doubtful: frozenset[str]) -> Iterator[Diagnostic]:
        """Return warnings about beliefs that nothing reads, and whose names are nearly those of others that are read."""
        for name, (meant, adders) in self._misspelt.items():
            for each in adders if name not in doubtful else ():
                if each.literal is not None and is_own(each.literal):
                    message = f"belief `{name}/{each.size}` is added, but nothing reads it"
                    yield problem(MISSPELT, message, each.literal.span, did_you_mean([meant]))
        sizes: dict[str, set[int]] = {}
        for name, size in (reader.key for flow in self._flow.programs for reader in flow.readers):
            sizes.setdefault(name, set()).add(size)
        unsure = doubtful.union(name for name, _ in self._mentioned)
        for flow in self.flows:
            for name, adders in flow.adders.items() if self._knows_artifacts else ():
                if name not in unsure:
                    yield from _told_in_vain(name, adders, sizes.get(name, set()))
                    yield from _of_other_size(name, adders, sizes.get(name, set()))


def _told_in_vain(name: str, adders: Sequence[Adder], read: Set[int]) -> Iterator[Diagnostic]:
    """Return warnings about beliefs that callers outside may tell, and that nothing reads."""
    for each in adders:
        if each.how == "offer" and each.size not in read and each.literal is not None:
            message = f"callers may tell `{name}/{each.size}`, but nothing reads it"
            help = f"read it in a context, or react to it: `+{as_written(each.literal)} <- ...`"
            yield problem("unused-offer", message, each.literal.span, help)


def _of_other_size(name: str, adders: Sequence[Adder], read: Set[int]) -> Iterator[Diagnostic]:
    """Return warnings about beliefs that are read only with another number of arguments, which they also have."""
    used = read & {each.size for each in adders}
    for each in adders if used else ():
        told = each.how == "offer" or each.size in read
        if not told and each.literal is not None and is_own(each.literal):
            others = ", ".join(f"`{name}/{size}`" for size in sorted(read))
            what = "has a plan `+?`" if each.how == "plan" else "is added"
            message = f"belief `{name}/{each.size}` {what}, but only {others} is read"
            texts = [other.literal for other in adders if other.size in used and other.literal is not None]
            help = did_you_mean(map(format_term, texts[:1]))
            yield problem(UNKNOWN, message, each.literal.span, help or None)


def _misspelt_adders(
    flows: Sequence[ProgramFlow], known: Container[str]
) -> dict[str, tuple[str, Sequence[Adder]]]:
    """Return beliefs that are added but never read, by name: what is meant, and what adds them.

    If nothing adds the similar name either, the rarer of the two is wrong.

    Args:
        flows: all programs.
        known: properties and signals.
    """
    reads = Counter(reader.key[0] for flow in flows for reader in flow.readers)
    added: dict[str, list[Adder]] = {}
    for flow in flows:
        for name, adders in (*flow.adders.items(), *flow.told.items()):
            added.setdefault(name, []).extend(adders)
    used = reads.keys() | {name for flow in flows for name, _ in flow.mentioned}
    found: dict[str, tuple[str, Sequence[Adder]]] = {}
    for name in added.keys() - used:
        meant = min((each for each in reads if is_misspelt(name, each)), default="")
        if meant and (meant in added or meant in known or reads[meant] > len(added[name])):
            found[name] = meant, added[name]
    return found


def _from_wrong_source(reader: Reader, adders: Sequence[Adder]) -> Iterator[Diagnostic]:
    """Return a warning about a source that a belief never has: percepts that only the agent adds, and notes that only
    artifacts publish.
    """
    source, name = source_of(reader.literal), reader.literal.functor
    if source == "percept" and all(map(_is_note, adders)):
        help = "the agent adds it itself: write `[source(self)]`, or omit the source"
        yield _never(reader, f"no artifact has `{name}`, so its source is never `percept`", help)
    elif source == "self" and all(each.usage for each in adders):
        help = "write `[source(percept)]`, or omit the source"
        yield _never(reader, f"only artifacts have `{name}`, so its source is never `self`", help)


def _is_note(adder: Adder) -> bool:
    """Return whether a belief certainly has the agent itself as its source."""
    is_plain = adder.literal is not None and adder.literal.annotations is None
    return adder.how in ("fact", "step") and is_plain


def _of_rule(reader: Reader, conclusion: Adder) -> tuple[str, str]:
    name, size = reader.key
    rule, example = conclusion.rule, ""
    asked = rule and next((part for part in parts_of(rule.body) if isinstance(part, nodes.Literal)), None)
    if rule and asked:
        example = f": `+{format_term(asked)} : {format_term(rule.head)}`"
    help = f"rules cause no events; react to a belief in the body of the rule{example}"
    return f"`{name}/{size}` is the conclusion of a rule", help


def _never(reader: Reader, why: str, help: str) -> Diagnostic:
    name, size = reader.key
    message = f"event `{reader.sign}{name}/{size}` never happens: {why}"
    return problem(NEVER, message, reader.literal.span, help)


def _to_be_told(adder: Adder) -> str:
    literal = adder.literal
    where = f"{literal.span.file.name}:{literal.span.line}" if literal and literal.span else "another agent"
    told = format_term(literal) if literal else ""
    return f"{where} adds it for its own agent only; to pass it on: `.send(NAME, tell, {told})`"


def _is_built_in(name: str) -> bool:
    """Return whether code of JaCaROS's own artifacts defines a property or signal of this name."""
    defines = re.compile(rf"\b(?:define_property|signal|robot_property)\(\s*\"{re.escape(name)}\"")
    package = Path(file_texts.__file__).parents[2]
    files = (path for folder in ("artifacts", "robots") for path in (package / folder).rglob("*.py"))
    return any(defines.search(_read(path)) for path in files)


def _read(path: Path) -> str:
    return file_bytes(path).decode(errors="replace")


# Other files.


def words_elsewhere(folders: Iterable[Path], known: Set[Path], with_mappings: bool) -> frozenset[str] | None:
    """Return the words in files that may give agents beliefs; None if there are too many files.

    Args:
        folders: where they are searched.
        known: files whose content is known.
        with_mappings: whether other mapping files may belong to the project.
    """
    from jacaros.robots.mapping.file import is_mapping

    found: set[str] = set()
    for number, path in enumerate(_texts(folders)):
        if number >= _MOST_FILES:
            return None
        if path.resolve() in known or (path.suffix in MAPPINGS and not with_mappings and is_mapping(path)):
            continue
        try:
            text = _read(path)
        except OSError:
            continue
        if path.suffix not in (".asl", ".py") or _GIVES.search(text):
            found.update(_WORD.findall(text))
    return frozenset(found)


def _sources(types: "Iterable[type[Artifact]]") -> Iterator[Path]:
    """Yield the files of artifact types: what they give agents is known."""
    for each in types:
        mapping = getattr(each, "mapping", None)
        try:
            yield Path(mapping.file if mapping is not None else inspect.getfile(each)).resolve()
        except (OSError, TypeError):
            continue


def _texts(folders: Iterable[Path]) -> Iterator[Path]:
    for folder in dict.fromkeys(each.resolve() for each in folders):
        for place, inner, files in os.walk(folder):
            depth = len(Path(place).relative_to(folder).parts)
            inner[:] = sorted(name for name in inner if name[0] not in "._" and depth < _DEEPEST)
            yield from (Path(place, name) for name in sorted(files) if name.endswith(_TEXTS))
