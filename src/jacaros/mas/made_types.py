"""The types of artifacts that agents make, also where the plan that makes them is given the type by its goal.

A library has ``+!use_artifact(Name, Type) <- ... makeArtifact(Name, Type)``, and programs say
``!use_artifact(wheels, "ArtCmdVel")``.
"""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from jacaros.asl import nodes
from jacaros.asl.walk import walk
from jacaros.mas.deployment import Deployment

if TYPE_CHECKING:
    from collections.abc import Callable

    from jacaros.env.artifact import Artifact

_OPEN_WORLD: Final = frozenset({"linkRemoteWorkspace", "linkWorkspace", "linkWorkspaces", "mountWorkspace"})
"""Actions that bring artifacts of other systems in."""


class _Place(NamedTuple):
    """Where a type stands: an argument of an action or of a goal, maybe one of a library that comes with the package."""

    functor: str
    arity: int
    argument: int
    of_library: bool = False


_MAKING: Final = tuple(_Place("makeArtifact", arity, 1) for arity in (2, 3, 4))


def made_types(
    deployment: Deployment, programs: Sequence[nodes.Program], find_type: "Callable[[str], type[Artifact]]"
) -> "list[type[Artifact]] | None":
    """The types of all artifacts of a project; None when they are not known before it runs."""
    names = [artifact.type_name for workspace in deployment.workspaces for artifact in workspace.artifacts]
    for program in programs:
        made = type_names(program)
        if made is None:
            return None
        names += made
    try:
        return [find_type(name) for name in dict.fromkeys(names)]
    except Exception:
        # An unknown type, or a module with a mistake in it: that is told where it belongs.
        return None


def type_names(program: nodes.Program) -> list[str] | None:
    """The types that a program makes artifacts of; None when some are worked out at run time."""
    uses = list(_uses(program))
    if any(literal.functor in _OPEN_WORLD for literal, _ in uses):
        return None
    names: list[str] = []
    places = list(_MAKING)
    for place in places:  # it grows
        found = [each for each in uses if _key(each[0]) == (place.functor, place.arity)]
        if not found and place not in _MAKING and not place.of_library:
            return None  # somebody else is to give the agent that goal
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
    """All literals of a program but the triggers of plans, with their plans."""
    for plan in program.plans:
        for node in walk(plan.context, plan.body, plan.subplans):
            if isinstance(node, nodes.Literal):
                yield node, plan
    for node in walk(program.goals, program.beliefs):
        if isinstance(node, nodes.Literal):
            yield node, None


def _given_by_goal(wanted: nodes.Term, plan: nodes.Plan | None) -> _Place | None:
    """Which argument of a plan's goal a variable is; None when it is none."""
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
