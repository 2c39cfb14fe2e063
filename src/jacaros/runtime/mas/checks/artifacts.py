"""Check that artifacts of a project offer the actions of its programs, that the artifact types that agents use exist, and
that plans need resources that artifacts use.

Only certain errors are reported: a program may create artifacts of types computed at run time, artifacts may define
operations at run time, and an agent architecture may run actions itself.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from jacaros.agents.body.body import keys
from jacaros.agents.checks.annotations import needs_of
from jacaros.agents.checks.flow import is_own
from jacaros.agents.checks.formulas import Key, indicator_of
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.checks.handlers import bypassed_plans, handled_in, with_mark
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import UNDECLARED, nodes_in, walk
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.artifacts.env.arbiter import local_name, read_uses
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import UnknownArtifactType
from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.files.texts import close_matches, did_you_mean
from jacaros.runtime.mas.checks.arguments import unbound_arguments
from jacaros.runtime.mas.checks.observables import Observables
from jacaros.runtime.mas.deployment import AgentSpec, Deployment

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

    FindType = Callable[[str], type[Artifact]]

_OPEN_WORLD: Final = frozenset({"linkRemoteWorkspace", "linkWorkspace", "linkWorkspaces", "mountWorkspace"})
"""Actions that add artifacts of other systems."""

_FAKE: Final = "fake_action"
"""The goal by which a test simulates the environment."""


def check_artifacts(
    programs: Sequence[tuple[AgentSpec, nodes.Program]],
    types: "Sequence[type[Artifact]]",
    observables: Observables,
) -> list[Diagnostic]:
    """Return warnings about what agents do with the artifacts of a project.

    Args:
        programs: the agents with their programs, including included files.
        types: the types of all its artifacts.
        observables: reads the code of artifact types.
    """
    return [*_unknown_operations(programs, types, observables), *_unknown_resources(programs, types)]


# ---- operations


def _unknown_operations(
    programs: Sequence[tuple[AgentSpec, nodes.Program]],
    types: "Sequence[type[Artifact]]",
    observables: Observables,
) -> Iterator[Diagnostic]:
    if any(_is_open(program) for _, program in programs) or any(map(observables.may_add, types)):
        return
    offered = Offered(types)
    yield from bypassed_plans([program for _, program in programs])
    for agent, program in programs:
        if agent.agent_class:
            continue
        handled = handled_in(program.found)
        yield from unbound_arguments(filter(is_own, program.plans), types)
        for step in program.found.of(nodes.ExternalAction):
            if isinstance(step.action, nodes.Literal):
                yield from offered.check(step.action, handled)


_GOAL: Final = re.compile(r"no plan for `!(\w+)/(\d+)`")


def operations_as_goals(types: "Sequence[type[Artifact]]") -> Callable[[Diagnostic], Diagnostic]:
    """Return the function that adds the help to a warning about a goal without a plan that is an operation."""

    @cache
    def has(name: str, arity: int) -> bool:
        return Offered(types).has(name, arity)

    def helped(warning: Diagnostic) -> Diagnostic:
        goal = _GOAL.fullmatch(warning.message) if warning.code == "unknown-goal" else None
        if goal is None or not has(goal[1], int(goal[2])):
            return warning
        return replace(warning, help=f"to call the operation, write `{goal[1]}` without `!`")

    return helped


def _is_open(program: nodes.Program) -> bool:
    """Return whether a program adds others at run time, or a test answers its actions."""
    found = program.found
    return any(
        STANDARD.get(call.name, UNDECLARED).brings_in for call in found.of(nodes.InternalAction)
    ) or any(literal.functor == _FAKE for literal in found.of(nodes.Literal))


class Offered:
    """The operations that the artifacts of a project offer to agents."""

    def __init__(self, types: "Sequence[type[Artifact]]") -> None:
        self._types = types
        self._main = Environment(VirtualClock()).workspace("/main")
        self._personal = frozenset(keys())

    def has(self, name: str, arity: int) -> bool:
        """Return whether an artifact, or the agent's own body, offers an operation."""
        if f"{name}/{arity}" in self._personal or self._main.providers(name, arity):
            return True
        return any(each.interface.operations.find(name, arity) is not None for each in self._types)

    def lacks(self, action: nodes.Literal) -> bool:
        """Return whether no artifact offers an action of a file of the user."""
        return is_own(action) and not self.has(action.functor, len(action.arguments))

    def check(self, action: nodes.Literal, handled: Set[Key]) -> Iterator[Diagnostic]:
        """Return a warning if no artifact offers *action*. *handled* are the goals that its program has plans for."""
        name, arity = action.functor, len(action.arguments)
        if self.lacks(action):
            message = f"unknown operation `{name}/{arity}`: no artifact of the project has it"
            meant = with_mark((name, arity), handled, KnownActions(STANDARD))
            help = did_you_mean([meant]) if meant else self._help(name, arity)
            yield Diagnostic("warning", message, action.span, help, "unknown-operation")

    def _help(self, name: str, arity: int) -> str | None:
        known = list(self._personal)
        for artifact_type in self._types:
            known += artifact_type.interface.operations.keys()
        for artifact in self._main.artifacts():
            known += self._main.offers(artifact)
        same = [each for each in dict.fromkeys(known) if each.partition("/")[0] == name]
        shipped = [] if same else _shipped_with(name, arity)
        if shipped:
            files = " or ".join(f"`{each}`" for each in shipped)
            return f"the shipped mapping {files} has it; run with `--mapping {shipped[0]}`"
        return did_you_mean(same or close_matches(name, [each.partition("/")[0] for each in known])) or None


def lacks_actions(
    programs: Sequence[nodes.Program], types: "Sequence[type[Artifact]] | None", observables: Observables
) -> bool:
    """Return whether actions of programs may belong to artifacts other than of these types."""
    if types is None or any(map(_is_open, programs)) or any(map(observables.may_add, types)):
        return True
    offered = Offered(types)
    actions = (step.action for each in programs for step in each.found.of(nodes.ExternalAction))
    return any(offered.lacks(each) for each in actions if isinstance(each, nodes.Literal))


def shipped_with(name: str) -> list[Path]:
    """Return the mappings of the package that have a property, signal or operation of this name."""
    from jacaros.robots.mapping.file import SHIPPED  # here: few programs need them

    # Reading YAML is slow: the name is searched in the text.
    entry = re.compile(rf"^ +{re.escape(name)}:", re.MULTILINE)
    return [path for path in sorted(SHIPPED.glob("*.yaml")) if entry.search(path.read_text(encoding="utf-8"))]


def _shipped_with(name: str, arity: int) -> list[str]:
    """Return the mappings of the package that have an operation."""
    from jacaros.robots.mapping.file import load_mapping  # here: few programs need it

    return [
        path.name
        for path in shipped_with(name)
        if any(
            (part.name, len(part.parameters) + len(part.outputs)) == (name, arity)
            for artifact in load_mapping(path).artifacts.values()
            for part in artifact.operations
        )
    ]


# ---- resources


def _unknown_resources(
    programs: Sequence[tuple[AgentSpec, nodes.Program]], types: "Iterable[type[Artifact]]"
) -> Iterator[Diagnostic]:
    """Return warnings about resources that only one plan names. They are probably misspelt.

    Plans may share a resource that no artifact uses. So if several plans need it, it is reported only if its name is
    similar to that of an artifact's resource.
    """
    known = sorted(set(_resources(types)))
    found = [each for _, program in programs for each in needs_of(program.found)]
    counts = Counter(name for name, _ in found)
    for name, item in found if known else ():
        close = close_matches(name, known)
        if local_name(name) not in known and (close or counts[name] == 1):
            message = f"unknown resource `{name}`: no artifact of the project uses it"
            help = did_you_mean(close, f"resources of the project: {', '.join(known)}")
            yield Diagnostic("warning", message, item.span, help, "unknown-resource")


def _resources(types: "Iterable[type[Artifact]]") -> Iterator[str]:
    for each in types:
        for table in (each.interface.operations, each.interface.links):
            yield from (name for declared in table for name in declared.uses)
        yield from read_uses(getattr(each, "further_uses", ()))


# ---- types


class _Place(NamedTuple):
    """Where a type is named: an argument of an action or goal, possibly of a library of JaCaROS."""

    functor: str
    arity: int
    argument: int
    of_library: bool = False


_MAKING: Final = tuple(_Place("makeArtifact", arity, 1, of_library=True) for arity in (2, 3, 4))


class _NamedType(NamedTuple):
    name: str
    term: nodes.Term
    of_library: bool
    """Whether it is an argument of an action or of a goal of a library, which is certainly a type."""


class NamedTypes(NamedTuple):
    """The types that a program creates artifacts of."""

    found: Sequence[_NamedType]
    certain: bool
    """Whether it creates no others at run time."""


def unknown_types(
    named: Iterable[NamedTypes], folders: Sequence[Path], find_type: "FindType"
) -> Iterator[Diagnostic]:
    """Warn of types that programs name and that do not exist, but for mapping files with errors."""
    for each in (each for one in named for each in one.found if each.of_library):
        try:
            find_type(each.name)
        except UnknownArtifactType as unknown:
            if not is_wrong_mapping(each.name, folders):
                yield Diagnostic(
                    "warning", str(unknown), each.term.span, unknown.help, code="unknown-artifact-type"
                )
        except Exception:
            # The module has an error, which a run reports.
            continue


def is_wrong_mapping(type_name: str, folders: Sequence[Path]) -> bool:
    """Return whether an artifact's type is a mapping file with errors, which are reported there."""
    if not type_name.partition("#")[0].endswith((".yaml", ".yml")):
        return False
    from jacaros.runtime.mas.mappings import is_wrong  # here: few projects have mappings

    return is_wrong(type_name, folders)


def made_types(
    deployment: Deployment, named: Iterable[NamedTypes], find_type: "FindType"
) -> "list[type[Artifact]] | None":
    """Return the types of all artifacts of a project; None if they are not known before it runs."""
    names = [artifact.type_name for workspace in deployment.workspaces for artifact in workspace.artifacts]
    for one in named:
        if not one.certain:
            return None
        names += [each.name for each in one.found]
    try:
        return list(dict.fromkeys(map(find_type, dict.fromkeys(names))))
    except Exception:
        # An unknown type, or a module with an error, is reported at its location.
        return None


def named_types(program: nodes.Program) -> NamedTypes:
    """Return the types that a program names. One may be the argument of a goal whose plan creates the artifact."""
    uses: dict[Key, list[tuple[nodes.Literal, nodes.Plan | None]]] = {}
    posted: set[Key] = set()
    for plan, literals in _uses(program):
        for literal in literals:
            uses.setdefault(indicator_of(literal), []).append((literal, plan))
        if not _is_of_library(plan):
            posted.update(map(indicator_of, literals))
    certain = not any(name in _OPEN_WORLD for name, _ in uses)
    named: list[_NamedType] = []
    places = list(_MAKING)
    for place in places:  # the list grows while it is iterated
        found = uses.get((place.functor, place.arity), [])
        certain &= bool(found) or place.of_library  # other goals come from outside
        for literal, plan in found:
            wanted = literal.arguments[place.argument]
            name = type_of(wanted)
            if name is not None:
                if plan is None or not _is_of_library(plan) or indicator_of(plan.trigger.literal) in posted:
                    named.append(_NamedType(name, wanted, place.of_library))
                continue
            given = _given_by_goal(wanted, plan)
            certain &= given is not None
            if given is not None and given not in places:
                places.append(given)
    return NamedTypes(named, certain)


def type_of(wanted: nodes.Term) -> str | None:
    """Return the type that a term names; None if it is computed at run time."""
    if isinstance(wanted, nodes.String):
        return wanted.value
    return wanted.functor if isinstance(wanted, nodes.Literal) and not wanted.arguments else None


def _uses(program: nodes.Program) -> Iterator[tuple[nodes.Plan | None, list[nodes.Literal]]]:
    """Yield the literals of each plan except its trigger, and those of beliefs and goals without a plan."""
    for plan, found in program.in_plans:
        head = set(map(id, walk(plan.label, plan.trigger)))
        yield plan, [each for each in found.of(nodes.Literal) if id(each) not in head]
    yield None, list(nodes_in(nodes.Literal, (program.goals, program.beliefs)))


def _given_by_goal(wanted: nodes.Term, plan: nodes.Plan | None) -> _Place | None:
    """Return which argument of a plan's goal a variable is, or None."""
    if plan is None or not isinstance(wanted, nodes.Variable) or plan.trigger.kind != "!":
        return None
    goal = plan.trigger.literal
    if not isinstance(goal, nodes.Literal):
        return None
    for number, argument in enumerate(goal.arguments):
        if isinstance(argument, nodes.Variable) and argument.name == wanted.name:
            return _Place(*indicator_of(goal), number, _is_of_library(plan))
    return None


def _is_of_library(plan: nodes.Plan | None) -> bool:
    return plan is not None and not is_own(plan)
