"""Check that agents focus the artifacts whose properties they use, and that some agent can reach each artifact.

Only an agent whose program shows all that it focuses is looked at.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from itertools import chain
from typing import TYPE_CHECKING, Final

from jacaros.agents.checks.flow import ProgramFlow, Reader, is_own, key_of
from jacaros.agents.checks.formulas import indicator_of
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import ByKind
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
_MAKING: Final = frozenset({"makeArtifact", "create_artifact", _USING})
"""The action, and the goals of the library, that make an artifact from a name and a type."""
_FINDING: Final = frozenset({"lookupArtifact", "artifact"})
"""The action, and the test goal of the library, that find an artifact by its name."""
_MAIN: Final = "main"
_REACHING: Final = _FOCUSING | {"joinWorkspace", "makeArtifact", "lookupArtifact"}
"""Actions by which an agent may reach artifacts that the project does not give it."""
_WORD: Final = re.compile(r"\w+")

Plans = Sequence[tuple[nodes.Plan, ByKind]]
Programs = Sequence[tuple[AgentSpec, nodes.Program]]


def check_focus(
    deployment: Deployment,
    programs: Programs,
    properties: "Properties",
    offers: "Offers",
    flows: Mapping[int, ProgramFlow],
    elsewhere: frozenset[str] = frozenset(),
) -> list[Diagnostic]:
    """Return warnings about properties of artifacts that agents do not focus, and artifacts that agents cannot use.

    Args:
        deployment: the project.
        programs: all its agents with their programs, but for those in Python.
        properties: returns the names of properties and signals of an artifact type; None if they are not known.
        offers: returns whether an artifact type has an operation of a name and a number of arguments.
        flows: where programs have their beliefs from, by the identities of the programs.
        elsewhere: the words in the code of agents in Python, which may join, make or tell what they name.
    """
    joined = {name for agent in (*deployment.agents, *(each for each, _ in programs)) for name in agent.join}
    return [
        *_out_of_reach(deployment, programs, joined, elsewhere),
        *(
            each
            for agent, program in programs
            for each in _not_joined(deployment, agent, program, joined, offers)
        ),
        *_Focus(deployment, programs, properties).findings(flows, elsewhere),
    ]


# ---- workspaces


def _out_of_reach(
    deployment: Deployment, programs: Programs, joined: Set[str], elsewhere: frozenset[str]
) -> Iterator[Diagnostic]:
    named = elsewhere.union(word for _, program in programs for word in _words(program))
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
            own = [(plan, in_plan) for plan, in_plan in program.in_plans if is_own(plan.trigger.literal)]
            posted = {indicator_of(step.goal)[0] for _, in_plan in own for step in in_plan.of(nodes.Achieve)}
            called = [each for each in program.in_plans if indicator_of(each[0].trigger.literal)[0] in posted]
            for name, kind, _ in chain.from_iterable(_made(in_plan) for _, in_plan in (*own, *called)):
                if kind:
                    self._by_name.setdefault(name, set()).add(kind)

    def findings(self, flow_of: Mapping[int, ProgramFlow], elsewhere: frozenset[str]) -> Iterator[Diagnostic]:
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
        flows = [flow_of[id(program)] for _, program in self._programs]
        if any(flow.is_open or flow.tells_unseen for flow in flows):
            return
        added = elsewhere.union(name for flow in flows for name in (*flow.adders, *flow.told))
        focused: dict[str, set[str]] = {}  # the properties that agents with a file focus
        for flow, own in zip(flows, seen, strict=True):
            for file in flow.files:
                focused.setdefault(file, set()).update(own)
        for (agent, program), flow in zip(self._programs, flows, strict=True):
            for reader in _first(flow.readers):
                name = reader.key[0]
                file = reader.literal.span.file.name if reader.literal.span is not None else ""
                if name in owners and name not in added and name not in focused.get(file, owners):
                    yield self._warning(agent, program, reader, owners[name])

    def _warning(self, agent: AgentSpec, program: nodes.Program, reader: Reader, kind: str) -> Diagnostic:
        found = [(space, each.name) for (space, _), each in self._declared.items() if each.type_name == kind]
        artifact = found[0][1] if found else kind
        who = agent.declared_name or agent.name
        message = f"`{reader.key[0]}` comes from artifact `{artifact}`, which agent `{who}` does not focus"
        help = (
            f"write `focus: {'.'.join(found[0])}` in the declaration of agent `{who}`"
            if found and agent.span is not None
            else f"focus the artifact after it is made: `{self._made_by(program, kind)}`"
        )
        return Diagnostic("warning", message, reader.literal.span, help, CODE)

    def _made_by(self, program: nodes.Program, kind: str) -> str:
        """Return the step that a test goal finds an artifact of a type with, or one that makes it, and a focus."""
        for plan, in_plan in program.in_plans:
            for step in _tests(in_plan) if is_own(plan.trigger.literal) else ():
                last = step.arguments[-1] if step.arguments else None
                if isinstance(last, nodes.Variable) and kind in (
                    self._meant(last, in_plan, program.in_plans) or ()
                ):
                    return f"?{format_term(step)}; focus({last.name})"
        return "makeArtifact(..., Id); focus(Id)"

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
                kinds = self._meant(each.arguments[0], in_plan, program.in_plans)
                if kinds is None:
                    return None
                found |= kinds
        return found

    def _meant(self, term: nodes.Term, in_plan: ByKind, plans: Plans) -> set[str] | None:
        """Return the types that an argument of ``focus`` may refer to; *plans* may answer test goals."""
        if not isinstance(term, nodes.Variable):
            name = type_of(term)
            return None if name is None else self._by_name.get(name.rpartition(".")[2])
        found: list[set[str] | None] = [{kind} for _, kind, made in _made(in_plan) if made == term]
        for step in (*_actions(in_plan), *_tests(in_plan)):
            if step.arguments[-1:] != (term,):
                continue
            if step.functor in _FINDING and len(step.arguments) > 1:
                name = type_of(step.arguments[0])
                found.append(None if name is None else self._by_name.get(name.rpartition(".")[2], set()))
                continue
            for answer, in_answer in plans:
                head, trigger = answer.trigger.literal, answer.trigger
                if (trigger.operator, trigger.kind) != ("+", "?") or not isinstance(head, nodes.Literal):
                    continue
                if key_of(head) == key_of(step):
                    rest = [each for each in plans if each[0] is not answer]
                    found.append(self._meant(head.arguments[-1], in_answer, rest))
        known = [each for each in found if each is not None]
        return set().union(*known) if known and len(known) == len(found) else None


def _tests(found: ByKind) -> list[nodes.Literal]:
    return [step.formula for step in found.of(nodes.Test) if isinstance(step.formula, nodes.Literal)]


def _actions(found: ByKind) -> list[nodes.Literal]:
    steps = found.of(nodes.ExternalAction)
    return [step.action for step in steps if isinstance(step.action, nodes.Literal)]


def _made(found: ByKind) -> Iterator[tuple[str, str, nodes.Term | None]]:
    """Yield name, type and identifier of the artifacts that plans make."""
    goals = [step.goal for step in found.of(nodes.Achieve)]
    for each in (*_actions(found), *goals):
        if isinstance(each, nodes.Literal) and each.functor in _MAKING and len(each.arguments) >= 2:
            name, kind = map(type_of, each.arguments[:2])
            yield name or "", kind or "", each.arguments[3] if len(each.arguments) > 3 else None


def _first(readers: Iterable[Reader]) -> Iterator[Reader]:
    """Return the first reader of each belief in files of the project."""
    found: dict[str, Reader] = {}
    for reader in readers:
        if is_own(reader.literal) and reader.how != "deletion":
            found.setdefault(reader.key[0], reader)
    yield from found.values()
