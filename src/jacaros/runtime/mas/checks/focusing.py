"""Check that agents focus the artifacts whose properties they use, and that some agent can reach each artifact.

Only an agent whose program shows all that it focuses is looked at.
"""

import re
from collections.abc import Iterable, Iterator, Sequence, Set
from typing import TYPE_CHECKING, Final

from jacaros.agents.checks.flow import Reader, flows_of, is_own
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import ByKind
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.mas.checks.artifacts import Offered, type_of
from jacaros.runtime.mas.deployment import AgentSpec, Deployment

if TYPE_CHECKING:
    from collections.abc import Callable

    Properties = Callable[[str], Set[str] | None]
    Offers = Callable[[str, str, int], bool]

CODE: Final = "unfocused-artifact"
_FOCUSING: Final = frozenset({"focus", "focusWhenAvailable"})
_USING: Final = "use_artifact"
"""The goal of the library that makes and focuses an artifact."""
_MAIN: Final = "main"
_REACHING: Final = _FOCUSING | {"joinWorkspace", "makeArtifact", "lookupArtifact"}
"""Actions by which an agent may reach artifacts that the project does not give it."""
_WORD: Final = re.compile(r"\w+")

Programs = Sequence[tuple[AgentSpec, nodes.Program]]


def check_focus(
    deployment: Deployment, programs: Programs, properties: "Properties", offers: "Offers"
) -> list[Diagnostic]:
    """Return warnings about properties of artifacts that agents do not focus, and artifacts that agents cannot use.

    Args:
        deployment: the project.
        programs: all its agents with their programs.
        properties: returns the names of properties and signals of an artifact type; None if they are not known.
        offers: returns whether an artifact type has an operation of a name and a number of arguments.
    """
    joined = {name for agent, _ in programs for name in agent.join}
    return [
        *_out_of_reach(deployment, programs, joined),
        *(
            each
            for agent, program in programs
            for each in _not_joined(deployment, agent, program, joined, offers)
        ),
        *_Focus(deployment, programs, properties).findings(),
    ]


# ---- workspaces


def _out_of_reach(deployment: Deployment, programs: Programs, joined: Set[str]) -> Iterator[Diagnostic]:
    named = {word for _, program in programs for word in _words(program)}
    for workspace in deployment.workspaces:
        for artifact in workspace.artifacts:
            names = {workspace.name, workspace.name.rpartition("/")[2], artifact.name}
            if workspace.name in joined or _MAIN in names or names & named or artifact.span is None:
                continue
            message = f"no agent can use `{artifact.name}`: none joins workspace `{workspace.name}`"
            help = f"write `focus: {workspace.name}.{artifact.name}` in the declaration of an agent"
            yield Diagnostic("warning", message, artifact.span, help, CODE)


def _not_joined(
    deployment: Deployment, agent: AgentSpec, program: nodes.Program, joined: Set[str], offers: "Offers"
) -> Iterator[Diagnostic]:
    """Warn of operations of workspaces that only other agents join; a program that may join others is skipped."""
    actions = _actions(program.found)
    if not _REACHING.isdisjoint(each.functor for each in actions) or agent.agent_class:
        return
    everywhere = Offered(())
    for action in {each.functor: each for each in reversed(actions) if is_own(each)}.values():
        having = [
            (workspace.name, artifact.name)
            for workspace in deployment.workspaces
            for artifact in workspace.artifacts
            if workspace.name in joined | {_MAIN}
            and offers(artifact.type_name, action.functor, len(action.arguments))
        ]
        is_near = any(name == _MAIN or name in agent.join for name, _ in having)
        if not having or is_near or everywhere.has(action.functor, len(action.arguments)):
            continue
        (workspace, artifact), who = having[0], agent.declared_name
        where = f"`{artifact}` in workspace `{workspace}`"
        message = f"`{action.functor}` is an operation of {where}, which agent `{who}` does not join"
        help = f"write `focus: {workspace}.{artifact}` in the declaration of agent `{who}`"
        yield Diagnostic("warning", message, action.span, help, CODE)


def _words(program: nodes.Program) -> Iterator[str]:
    for text in program.found.of(nodes.String):
        yield from _WORD.findall(text.value)
    yield from (literal.functor for literal in program.found.of(nodes.Literal))


# ---- properties


class _Focus:
    """What the agents of a project focus."""

    def __init__(self, deployment: Deployment, programs: Programs, properties: "Properties") -> None:
        self._programs, self._properties = programs, properties
        self._declared = {
            (workspace.name, artifact.name): artifact
            for workspace in deployment.workspaces
            for artifact in workspace.artifacts
        }
        self._by_name: dict[str, set[str]] = {}
        for artifact in self._declared.values():
            self._by_name.setdefault(artifact.name, set()).add(artifact.type_name)
        for _, program in programs:
            for name, kind, _ in _made(program.found):
                if kind:
                    self._by_name.setdefault(name, set()).add(kind)

    def findings(self) -> Iterator[Diagnostic]:
        """Return a warning for each property that an agent uses and does not focus."""
        owners = self._owners()
        if owners is None:
            return
        seen: list[set[str]] = []  # for each agent
        for agent, program in self._programs:
            kinds = self._focused(agent, program)
            if kinds is None or agent.agent_class:
                return
            seen.append({name for kind in kinds for name in self._properties(kind) or ()})
        if all(each >= owners.keys() for each in seen):
            return
        flows = flows_of([program for _, program in self._programs], STANDARD)
        if any(flow.is_open or flow.tells_unseen for flow in flows):
            return
        added = {name for flow in flows for name in (*flow.adders, *flow.told)}
        focused: dict[str, set[str]] = {}  # the properties that agents with a file focus
        for flow, own in zip(flows, seen, strict=True):
            for file in flow.files:
                focused.setdefault(file, set()).update(own)
        for (agent, _), flow in zip(self._programs, flows, strict=True):
            for reader in _first(flow.readers):
                name = reader.key[0]
                file = reader.literal.span.file.name if reader.literal.span is not None else ""
                if name in owners and name not in added and name not in focused.get(file, owners):
                    yield self._warning(agent, reader, owners[name])

    def _warning(self, agent: AgentSpec, reader: Reader, kind: str) -> Diagnostic:
        found = [(space, each.name) for (space, _), each in self._declared.items() if each.type_name == kind]
        artifact = found[0][1] if found else kind
        who = agent.declared_name or agent.name
        message = f"`{reader.key[0]}` comes from artifact `{artifact}`, which agent `{who}` does not focus"
        help = (
            f"write `focus: {'.'.join(found[0])}` in the declaration of agent `{who}`"
            if found and agent.span is not None
            else "focus the artifact after it is made: `makeArtifact(..., Id); focus(Id)`"
        )
        return Diagnostic("warning", message, reader.literal.span, help, CODE)

    def _owners(self) -> dict[str, str] | None:
        """Return the type of artifact that each property and signal comes from; None if they are not known."""
        found: dict[str, str] = {}
        for kind in sorted({kind for kinds in self._by_name.values() for kind in kinds}):
            names = self._properties(kind)
            if names is None:
                return None
            found |= dict.fromkeys(names, kind)
        return found

    def _focused(self, agent: AgentSpec, program: nodes.Program) -> set[str] | None:
        """Return the types of artifacts that an agent focuses; None if its program computes them."""
        found = {
            artifact.type_name
            for (space, name), artifact in self._declared.items()
            if any(each.artifact == name and each.workspace in (None, space) for each in agent.focus)
        }
        goals = [step.goal for step in program.found.of(nodes.Achieve)]
        for goal in goals:
            if isinstance(goal, nodes.Literal) and goal.functor == _USING and is_own(goal):
                kind = type_of(goal.arguments[1]) if len(goal.arguments) > 1 else None
                if kind is None:
                    return None
                found.add(kind)
        posted = {goal.functor for goal in goals if isinstance(goal, nodes.Literal)} - {_USING}
        for plan, in_plan in program.in_plans:
            literal = plan.trigger.literal
            focuses = [each for each in _actions(in_plan) if each.functor in _FOCUSING and each.arguments]
            if focuses and not is_own(focuses[0]):
                if isinstance(literal, nodes.Literal) and literal.functor in posted:
                    return None
                continue
            for each in focuses:
                kinds = self._meant(each.arguments[0], in_plan)
                if kinds is None:
                    return None
                found |= kinds
        return found

    def _meant(self, term: nodes.Term, in_plan: ByKind) -> set[str] | None:
        """Return the types that an argument of ``focus`` may refer to."""
        if isinstance(term, nodes.Variable):
            made = {kind for _, kind, identifier in _made(in_plan) if identifier == term}
            looked_up = [
                each.arguments[0]
                for each in _actions(in_plan)
                if each.functor == "lookupArtifact" and each.arguments[1:] == (term,)
            ]
            names = [type_of(each) for each in looked_up]
            if (not made and not names) or None in names:
                return None
            return made.union(*(self._by_name.get(name.rpartition(".")[2], set()) for name in names if name))
        name = type_of(term)
        return None if name is None else self._by_name.get(name.rpartition(".")[2])


def _actions(found: ByKind) -> list[nodes.Literal]:
    steps = found.of(nodes.ExternalAction)
    return [step.action for step in steps if isinstance(step.action, nodes.Literal)]


def _made(found: ByKind) -> Iterator[tuple[str, str, nodes.Term | None]]:
    """Yield name, type and identifier of the artifacts that plans make."""
    for action in _actions(found):
        if action.functor == "makeArtifact" and len(action.arguments) >= 2:
            name, kind = map(type_of, action.arguments[:2])
            yield name or "", kind or "", action.arguments[3] if len(action.arguments) > 3 else None


def _first(readers: Iterable[Reader]) -> Iterator[Reader]:
    """Return the first reader of each belief in files of the project."""
    found: dict[str, Reader] = {}
    for reader in readers:
        if is_own(reader.literal) and reader.how != "deletion":
            found.setdefault(reader.key[0], reader)
    yield from found.values()
