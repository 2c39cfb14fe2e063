"""Check that artifacts of a project offer the actions of its programs, and that the artifact types that agents use exist.

Only certain errors are reported: a program may create artifacts of types computed at run time, artifacts may define
operations at run time, and an agent architecture may run actions itself.
"""

import inspect
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from jacaros.agents.body.body import keys
from jacaros.agents.checks.formulas import clauses as clauses_of
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import UNDECLARED, walk
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import UnknownArtifactType
from jacaros.files.texts import close_matches, did_you_mean
from jacaros.mas.deployment import AgentSpec, Deployment
from jacaros.runtime.clock import VirtualClock

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

    FindType = Callable[[str], type[Artifact]]

_MAKES: Final = "makeArtifact"
_USES: Final = frozenset({"use_artifact", "create_artifact"})
"""Goals of the artifact library with the same arguments."""
_OPEN_WORLD: Final = frozenset({"linkRemoteWorkspace", "linkWorkspace", "linkWorkspaces", "mountWorkspace"})
"""Actions that add artifacts of other systems."""

_FAKE: Final = "fake_action"
"""The goal by which a test simulates the environment."""

_CLOSED: Final = "jacaros.artifacts."
"""Modules whose artifacts have only the operations that their classes declare."""

_OPEN_METHODS: Final = ("define_operation", "make_artifact", "create(")
"""Methods that add operations at run time."""


class _NotCertain(Exception):
    """The operations of the project's artifacts are not known before it runs."""


def check_actions(
    deployment: Deployment, programs: Sequence[tuple[AgentSpec, nodes.Program]], find_type: "FindType"
) -> list[Diagnostic]:
    """Return warnings about unknown operations and unknown types of artifacts.

    Args:
        deployment: the project.
        programs: the agents with their programs, including included files.
        find_type: finds the project's artifact types.
    """
    found = [(agent, list(_steps(program))) for agent, program in programs]
    makes = [make for _, program in programs for make in _makes(program)]
    warnings = list(_unknown_types(makes, find_type))
    try:
        if any(_is_open(program) for _, program in programs):
            return warnings
        offered = _Offered(_types(deployment, makes, find_type))
    except _NotCertain:
        return warnings
    if any(step.functor in _OPEN_WORLD for _, steps in found for step in steps):
        return warnings
    for agent, steps in found:
        if not agent.agent_class:
            warnings += filter(None, map(offered.diagnose, steps))
    return warnings


def _steps(program: nodes.Program) -> Iterator[nodes.Literal]:
    """Return the actions in the plans of a program."""
    return _actions(*clauses_of(program))


def _actions(*roots: object) -> Iterator[nodes.Literal]:
    for node in walk(*roots):
        if isinstance(node, nodes.ExternalAction) and isinstance(node.action, nodes.Literal):
            yield node.action


def _makes(program: nodes.Program) -> Iterator[nodes.Literal]:
    """Return the steps ``makeArtifact(Name,Type,...)`` of a program, and its goals for library plans that create
    artifacts.
    """
    library = [plan for plan in program.plans if _is_of_library(plan)]
    offered = _goals(plan.trigger.literal for plan in library)
    own = [plan for plan in program.plans if not _is_of_library(plan)]
    posted = [*program.goals, *(node.goal for node in walk(*own) if isinstance(node, nodes.Achieve))]
    yield from (action for action in _actions(*own) if action.functor == _MAKES)
    wanted = [goal for goal in posted if isinstance(goal, nodes.Literal) and goal.functor in _USES]
    yield from (goal for goal in wanted if (goal.functor, len(goal.arguments)) in offered)
    used = _goals(posted)
    for plan in library:
        head = plan.trigger.literal
        if isinstance(head, nodes.Literal) and (head.functor, len(head.arguments)) in used:
            goals = (node.goal for node in walk(plan.body) if isinstance(node, nodes.Achieve))
            for goal in goals:
                # A variable is a parameter of the plan: the goal names the type.
                if isinstance(goal, nodes.Literal) and goal.functor in _USES and _type_of(goal) is not None:
                    yield goal


def _goals(literals: Iterable[object]) -> set[tuple[str, int]]:
    return {(each.functor, len(each.arguments)) for each in literals if isinstance(each, nodes.Literal)}


def _is_of_library(plan: nodes.Plan) -> bool:
    return plan.span is not None and plan.span.file.name.startswith("$")


def artifact_types(program: nodes.Program) -> list[str]:
    """Return the artifact types that a program names."""
    return [name for make in _makes(program) if (name := _type_of(make)) is not None]


def _is_open(program: nodes.Program) -> bool:
    """Return whether a program adds others at run time, or a test answers its actions."""
    for node in walk(*clauses_of(program), *program.goals):
        if isinstance(node, nodes.InternalAction) and STANDARD.get(node.name, UNDECLARED).brings_in:
            return True
        if isinstance(node, nodes.Literal) and node.functor == _FAKE:
            return True
    return False


def _type_of(action: nodes.Literal) -> str | None:
    """Return the type in ``makeArtifact(Name,Type,...)`` or in such a goal; None if it is computed at run time."""
    if len(action.arguments) < 2:
        return None
    wanted = action.arguments[1]
    if isinstance(wanted, nodes.String):
        return wanted.value
    if isinstance(wanted, nodes.Literal) and not wanted.arguments:
        return wanted.functor
    return None


def _unknown_types(makes: Sequence[nodes.Literal], find_type: "FindType") -> Iterator[Diagnostic]:
    for action in makes:
        name = _type_of(action)
        if name is None:
            continue
        try:
            find_type(name)
        except UnknownArtifactType as unknown:
            span = action.arguments[1].span
            yield Diagnostic("warning", str(unknown), span, code="unknown-artifact-type")
        except Exception:
            # The module has an error, which a run reports.
            continue


def _types(
    deployment: Deployment, makes: Sequence[nodes.Literal], find_type: "FindType"
) -> "list[type[Artifact]]":
    """Return all artifact types of the project.

    Raises:
        _NotCertain: not all of them are known.
    """
    names = [artifact.type_name for workspace in deployment.workspaces for artifact in workspace.artifacts]
    for action in makes:
        name = _type_of(action)
        if name is None:
            raise _NotCertain
        names.append(name)
    try:
        types = [find_type(name) for name in dict.fromkeys(names)]
    except Exception as error:
        raise _NotCertain from error
    if any(map(_offers_more, types)):
        raise _NotCertain
    return types


def _offers_more(artifact_type: "type[Artifact]") -> bool:
    """Return whether artifacts of a type may define operations, or create other artifacts, at run time."""
    for each in artifact_type.__mro__:
        if each.__module__.startswith(_CLOSED) or each is object:
            continue
        try:
            source = inspect.getsource(each)
        except (OSError, TypeError):
            return True
        if any(method in source for method in _OPEN_METHODS):
            return True
    return False


class _Offered:
    """The operations that the artifacts of a project offer to agents."""

    def __init__(self, types: "list[type[Artifact]]") -> None:
        self._types = types
        self._main = Environment(VirtualClock()).workspace("/main")
        self._personal = frozenset(keys())

    def _has(self, name: str, arity: int) -> bool:
        if f"{name}/{arity}" in self._personal or self._main.providers(name, arity):
            return True
        return any(each.interface.operations.find(name, arity) is not None for each in self._types)

    def diagnose(self, action: nodes.Literal) -> Diagnostic | None:
        """Return a warning if no artifact offers *action*."""
        span = action.span
        if span is None or span.file.name.startswith("$") or self._has(action.functor, len(action.arguments)):
            return None
        key = f"{action.functor}/{len(action.arguments)}"
        message = f"unknown operation `{key}`: no artifact of the project has it"
        return Diagnostic("warning", message, span, self._help(key), "unknown-operation")

    def _help(self, key: str) -> str | None:
        known = list(self._personal)
        for artifact_type in self._types:
            known += artifact_type.interface.operations.keys()
        for artifact in self._main.artifacts():
            known += self._main.offers(artifact)
        name = key.partition("/")[0]
        same = [each for each in dict.fromkeys(known) if each.partition("/")[0] == name]
        return did_you_mean(same or close_matches(name, [each.partition("/")[0] for each in known])) or None


class _Place(NamedTuple):
    """Where a type is named: an argument of an action or goal, possibly of a library of JaCaROS."""

    functor: str
    arity: int
    argument: int
    of_library: bool = False


_MAKING: Final = tuple(_Place("makeArtifact", arity, 1) for arity in (2, 3, 4))


def made_types(
    deployment: Deployment, programs: Sequence[nodes.Program], find_type: "Callable[[str], type[Artifact]]"
) -> "list[type[Artifact]] | None":
    """Return the types of all artifacts of a project; None if they are not known before it runs."""
    names = [artifact.type_name for workspace in deployment.workspaces for artifact in workspace.artifacts]
    for program in programs:
        made = type_names(program)
        if made is None:
            return None
        names += made
    try:
        return [find_type(name) for name in dict.fromkeys(names)]
    except Exception:
        # An unknown type, or a module with an error, is reported at its location.
        return None


def type_names(program: nodes.Program) -> list[str] | None:
    """Return the types that a program creates artifacts of; None if some are computed at run time."""
    uses = list(_uses(program))
    if any(literal.functor in _OPEN_WORLD for literal, _ in uses):
        return None
    names: list[str] = []
    places = list(_MAKING)
    for place in places:  # the list grows while it is iterated
        found = [each for each in uses if _key(each[0]) == (place.functor, place.arity)]
        if not found and place not in _MAKING and not place.of_library:
            return None  # the goal comes from outside
        for literal, plan in found:
            wanted = literal.arguments[place.argument]
            if isinstance(wanted, nodes.String):
                names.append(wanted.value)
            elif isinstance(wanted, nodes.Literal) and not wanted.arguments:
                names.append(wanted.functor)
            else:
                given = _given_by_goal(wanted, plan)
                if given is None:
                    return None
                if given not in places:
                    places.append(given)
    return names


def _key(literal: nodes.Literal) -> tuple[str, int]:
    return literal.functor, len(literal.arguments)


def _uses(program: nodes.Program) -> Iterator[tuple[nodes.Literal, nodes.Plan | None]]:
    """Return all literals of a program except triggers of plans, with their plans."""
    for plan in program.plans:
        for node in walk(plan.context, plan.body, plan.subplans):
            if isinstance(node, nodes.Literal):
                yield node, plan
    for node in walk(program.goals, program.beliefs):
        if isinstance(node, nodes.Literal):
            yield node, None


def _given_by_goal(wanted: nodes.Term, plan: nodes.Plan | None) -> _Place | None:
    """Return which argument of a plan's goal a variable is, or None."""
    if plan is None or not isinstance(wanted, nodes.Variable) or plan.trigger.kind != "!":
        return None
    goal = plan.trigger.literal
    if not isinstance(goal, nodes.Literal):
        return None
    for number, argument in enumerate(goal.arguments):
        if isinstance(argument, nodes.Variable) and argument.name == wanted.name:
            is_library = plan.span is not None and plan.span.file.name.startswith("$")
            return _Place(goal.functor, len(goal.arguments), number, is_library)
    return None
