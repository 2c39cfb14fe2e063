"""`.mas2j` project files."""

import re
from typing import ClassVar, Final

from jacaros.agents.language.cursor import is_slip_of
from jacaros.runtime.files.texts import did_you_mean, suggestion
from jacaros.runtime.mas.deployment import CARTAGO_ENVIRONMENTS, NodeSpec
from jacaros.runtime.mas.project.cursor import ProjectPanic, ProjectToken, text_of
from jacaros.runtime.mas.project.declarations import (
    INFRASTRUCTURES,
    JAVA,
    JAVA_ENVIRONMENT,
    AgentPart,
    WrittenName,
)
from jacaros.runtime.mas.project.language import ProjectReader

_AGENT_KEYS: Final = ("agentArchClass", "agentClass", "beliefBaseClass", "at")
_OWN_INFRASTRUCTURES: Final = ("local", "centralised", "centralized")
"""Infrastructures that JaCaROS replaces, so they need no warning, in lower case."""
_VALUE: Final = ("string", "word", "number")


class Mas2jReader(ProjectReader):
    """Reads a `.mas2j` file."""

    keyword, kind = "MAS", ".mas2j"

    def head(self) -> None:
        self.part.name = self.name("the name of the system").text

    def at_next_section(self) -> bool:
        return self.token.kind == "}" or self.at_key_of_project()

    def _infrastructure(self, _: ProjectToken) -> None:
        """Read the infrastructure. Agents always share one process here."""
        token = self.token
        self._class()
        if token.text.lower() not in _OWN_INFRASTRUCTURES:
            span = self.span_of(token)
            self.unsupported(INFRASTRUCTURES, f"the infrastructure `{token.text}`", span)

    def _environment(self, _: ProjectToken) -> None:
        """Read the class of the environment. A Java class has no effect."""
        token = self.token
        self.part.environment = self._class()
        name = self.part.environment.partition("(")[0]
        if name not in CARTAGO_ENVIRONMENTS:
            self.unsupported(JAVA_ENVIRONMENT, f"the environment `{name}`", self.span_of(token))

    def _java(self, key: ProjectToken) -> None:
        self.raw(self.at_next_section)
        self.unsupported(JAVA, f"`{key.text}`", self.span_of(key))

    def _source_path(self, _: ProjectToken) -> None:
        while self.token.kind in ("string", "word") and not self.at_next_section():
            self.part.source_paths.append(text_of(self.advance()))
            if not (self.accept(";") or self.accept(",")):
                break

    def _world(self, _: ProjectToken) -> None:
        self.world(_VALUE)
        self.accept(";")

    def _mapping(self, _: ProjectToken) -> None:
        token = self.take("the name of a mapping file", *_VALUE)
        self.part.mappings.append((text_of(token), self.span_of(token)))
        self.accept(";")

    def _class(self) -> str:
        """Return a class with its arguments, as written, without a following ``at "host"``."""
        text = self.name("a class name").text + self.parameters()
        if self.accept("at"):
            self._host()
        self.accept(";")
        return text

    def _host(self) -> WrittenName:
        """Read a host, which declares a node. That of the environment comes first."""
        token = self.take("the name of a host", *_VALUE)
        host, span = text_of(token), self.span_of(token)
        name = re.sub(r"[.:]", "-", host)  # members of a fleet have no dots in their names
        if name not in (node.name for node in self.part.nodes):
            self.part.nodes.append(NodeSpec(name, host, span))
        return name, span

    # agents

    def _agents(self, _: ProjectToken) -> None:
        if self.at_next_section():
            self.report("expected at least one agent")
        while not self.at_next_section() and self.token.kind != "end":
            try:
                self._agent()
            except ProjectPanic:
                self._to_next_agent()

    def _to_next_agent(self) -> None:
        while self.token.kind != "end" and not self.at_next_section():
            if self.advance().kind == ";":
                return

    def _agent(self) -> None:
        if self.at_key():
            self.other_section()
        name = self.lower_name("the name of an agent")
        agent = AgentPart(name.text, self.span_of(name))
        if self.token.kind in ("word", "string") and self.token.text not in _AGENT_KEYS:
            self._refuse_misspelt_key()
            self._source(agent)
        if self.token.kind == "[":
            self._options(agent)
        while self.token.kind != ";":
            self._part_of_agent(agent)
        self.advance()
        self.part.agents.append(agent)

    def _refuse_misspelt_key(self) -> None:
        """Report a word before a class that is nearly a key. Otherwise it would be read as the agent's file."""
        written = self.token.text.lower()
        meant = [key for key in _AGENT_KEYS if key.lower() == written]
        if not meant and self.peek().kind == "word":
            meant = [key for key in _AGENT_KEYS[:3] if is_slip_of(written, key.lower())]
        if meant and self.token.kind == "word":
            self.fail(f"unexpected {self.token}", help=did_you_mean(meant[:1]))

    def _source(self, agent: AgentPart) -> None:
        token = self.advance()
        span = self.span_of(token)
        if token.first and token.kind == "word" and "/" not in token.text and "." not in token.text:
            # A file name may be on a line of its own, but then it must look like one.
            self.report(f"missing `;` after agent `{agent.name}`", span, "end each agent with `;`")
        else:
            agent.source, agent.source_span = text_of(token), span

    def _part_of_agent(self, agent: AgentPart) -> None:
        key = self.token
        if self.accept("#"):
            agent.instances = self._count()
            return
        if key.text not in _AGENT_KEYS or key.kind != "word":
            end = "end each agent with `;`"
            help = suggestion(key.text, _AGENT_KEYS, end) if key.kind == "word" else end
            self.fail(f"expected `;` after agent `{agent.name}`, found {key}", help=help)
        self.advance()
        if key.text == "at":
            agent.node = self._host()
        elif key.text == "agentClass":
            agent.agent_class = self.name("a class name").text + self.parameters()
        else:
            self._class_without_effect(key.text)
            while key.text == "agentArchClass" and self.accept(","):
                self._class_without_effect(key.text)

    def _class_without_effect(self, key: str) -> None:
        name = self.name("a class name")
        self.parameters()
        self.class_of_agent(key, name.text, self.span_of(name))

    def _count(self) -> int:
        token = self.take("a number of agents", *_VALUE)
        if token.kind != "number" or not token.text.isdecimal() or not 0 < len(token.text.lstrip("0")) < 7:
            message = f"expected a positive number of agents, found {token}"
            self.fail(message, self.span_of(token), "write `#3`")
        return int(token.text)

    def _options(self, agent: AgentPart) -> None:
        opener = self.advance()
        while not self.accept("]"):
            if self.token.kind == "end":
                self.fail("`[` is not closed", self.span_of(opener))
            key = self.name("the name of an option")
            self.expect("=", "write options as `[verbose=2, events=discard]`")
            value = self.take(f"the value of `{key.text}`", *_VALUE)
            text, span = text_of(value) + self.parameters(), self.span_of(value)
            if key.text in ("beliefs", "goals"):
                (agent.beliefs if key.text == "beliefs" else agent.goals).append((text, span))
            else:
                agent.options[key.text], agent.option_places[key.text] = text, span
            if self.token.kind != "]":
                self.expect(",", "separate options with `,`")

    readers: ClassVar = {
        "infrastructure": _infrastructure,
        "environment": _environment,
        "executionControl": _java,
        "agents": _agents,
        "directives": _java,
        "classpath": _java,
        "aslSourcePath": _source_path,
        "world": _world,
        "mapping": _mapping,
    }
    sections = tuple(readers)
