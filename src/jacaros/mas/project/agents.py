"""The agents of a project: programs, instances, joined workspaces and focused artifacts."""

from dataclasses import replace
from pathlib import Path
from typing import Final

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_literals
from jacaros.mas.agent_options import check_option
from jacaros.mas.deployment import AgentSpec, FocusSpec
from jacaros.mas.project.parts import AgentPart, ProjectPart, Written
from jacaros.mas.project.places import ProjectPlaces
from jacaros.mas.project.remarks import Remarks
from jacaros.mas.source_path import SourcePath

_PROGRAM: Final = ".asl"
_PYTHON: Final = ".py"


class ProjectAgents:
    """Finds the programs of agents and expands agents to their instances.

    Args:
        part: the declarations of the project.
        places: its workspaces and artifacts.
        remarks: collects diagnostics.
    """

    def __init__(self, part: ProjectPart, places: ProjectPlaces, remarks: Remarks) -> None:
        self._part, self._places, self._remarks = part, places, remarks

    def instances(self, agent: AgentPart) -> list[AgentSpec]:
        """Return one agent for each instance."""
        for option, value in agent.options.items():
            found = check_option(option, value, agent.option_places.get(option))
            if found is not None:
                self._remarks.add(found)
        first = AgentSpec(
            name=agent.name,
            source_path=self._source(agent),
            declared_name=agent.name,
            options=dict(agent.options),
            beliefs=self._literals(agent.beliefs, "belief"),
            goals=self._literals(agent.goals, "goal"),
            agent_class=agent.agent_class,
            host=agent.host,
            span=agent.span,
        )
        return [self._situated(replace(first, name=name), agent) for name in agent.instance_names()]

    # programs

    def _source(self, agent: AgentPart) -> Path:
        """Return the file of an agent's program."""
        written = agent.source or agent.name
        try:
            return SourcePath(agent.folders).find(written)
        except FileNotFoundError as missing:
            file = written if written.endswith((_PROGRAM, _PYTHON)) else written + _PROGRAM
            message = f"program of agent `{agent.name}` not found: {file}"
            self._remarks.error(message, agent.source_span or agent.span, str(missing))
            return (agent.folders or (Path(),))[0] / file

    def _literals(self, written: list[Written], what: str) -> str:
        """Return the literals, joined. Report what is not a literal."""
        for text, span in written:
            try:
                parse_literals(_literal(text))
            except AslError as error:
                message = error.diagnostics[0].message
                help = "write rules in the agent's program" if ":-" in text else None
                self._remarks.error(f"invalid {what} `{_first_line(text)}`: {message}", span, help)
            else:
                if text.startswith("!") and what == "belief":
                    self._remarks.error(
                        f"expected a belief, found the goal `{text}`", span, f"write `goals: {text[1:]}`"
                    )
        return ", ".join(_literal(text) for text, _ in written)

    # places

    def _situated(self, agent: AgentSpec, part: AgentPart) -> AgentSpec:
        """Return the instance *agent* of *part* with the workspaces it joins and the artifacts it focuses."""
        join = [self._places.join(wanted) for wanted in part.join]
        focus = [self._places.focus(wanted) for wanted in part.focus]
        for workspace in self._part.workspaces:
            name = self._places.shortest_name(workspace)
            if any(_means(written, agent) for written, _ in workspace.agents):
                join.append(name)
            for artifact in workspace.artifacts:
                focus += [
                    FocusSpec(artifact.spec.name, name, namespace)
                    for written, namespace, _ in artifact.focused_by
                    if _means(written, agent)
                ]
        join += [wanted.workspace for wanted in focus if wanted is not None]
        if not join and not focus:
            return agent
        return replace(
            agent,
            join=tuple(dict.fromkeys(name for name in join if name is not None)),
            focus=tuple(dict.fromkeys(wanted for wanted in focus if wanted is not None)),
        )


def _first_line(text: str) -> str:
    first, _, rest = text.partition("\n")
    return f"{first.rstrip()} ..." if rest else first


def _literal(text: str) -> str:
    return text.strip().rstrip(".,")


def _means(name: str, agent: AgentSpec) -> bool:
    return name in ("*", agent.name, agent.declared_name)
