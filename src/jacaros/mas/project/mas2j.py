"""`.mas2j` project files."""

from contextlib import suppress
from typing import Final, NoReturn

from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Span
from jacaros.files.texts import did_you_mean, suggestion
from jacaros.mas.deployment import CARTAGO_ENVIRONMENTS
from jacaros.mas.project.cursor import ProjectCursor, ProjectPanic, Token, text_of
from jacaros.mas.project.parts import AgentPart, ProjectPart
from jacaros.mas.project.unsupported import (
    INFRASTRUCTURES,
    JAVA,
    JAVA_ENVIRONMENT,
    NODES,
    Topic,
    Unsupported,
    class_without_effect,
)

_SECTIONS: Final = (
    "infrastructure",
    "environment",
    "executionControl",
    "agents",
    "directives",
    "classpath",
    "aslSourcePath",
    "world",
    "mapping",
)
_AGENT_KEYS: Final = ("agentArchClass", "agentClass", "beliefBaseClass", "at")
_OWN_INFRASTRUCTURES: Final = ("local", "centralised", "centralized")
"""Infrastructures that JaCaROS replaces, so they need no warning, in lower case."""


def read_mas2j(cursor: ProjectCursor) -> ProjectPart:
    """Return the declarations of a `.mas2j` file. Errors are collected in the cursor."""
    part = ProjectPart()
    with suppress(ProjectPanic):
        _Mas2jReader(cursor, part).project()
    return part


class _Mas2jReader:
    def __init__(self, cursor: ProjectCursor, part: ProjectPart) -> None:
        self.cursor = cursor
        self.part = part

    def project(self) -> None:
        cursor = self.cursor
        cursor.expect("MAS", "begin the file with `MAS name {`")
        self.part.name = cursor.name("the name of the system").text
        opener = cursor.expect("{", "begin the file with `MAS name {`")
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("`{` is not closed", cursor.span_of(opener), "end the file with `}`")
            start = cursor.index
            try:
                self.section()
            except ProjectPanic:
                self.to_next_section(start)
                if cursor.token.kind == "end":
                    return  # the error may have consumed the closing bracket of the file
        if cursor.token.kind != "end":
            cursor.report(
                f"unexpected {cursor.token} after the end of the system",
                help="check for an extra `}` before it",
            )

    def section(self) -> None:
        cursor = self.cursor
        if not cursor.at_key() or cursor.token.text not in _SECTIONS:
            self.no_section()
        key = cursor.advance()
        cursor.advance()
        match key.text:
            case "agents":
                self.agents()
            case "aslSourcePath":
                self.source_path()
            case "world":
                name = self.value("the name of a world file")
                self.part.world, self.part.world_span = text_of(name), cursor.span_of(name)
                cursor.accept(";")
            case "mapping":
                token = self.value("the name of a mapping file")
                self.part.mappings.append((text_of(token), cursor.span_of(token)))
                cursor.accept(";")
            case "environment":
                self.environment()
            case "infrastructure":
                self.infrastructure()
            case _:
                span = cursor.span_of(key)
                cursor.raw(self.at_section_or_end)
                self.unsupported(JAVA, f"`{key.text}`", span)

    def unsupported(self, topic: Topic, what: str, span: Span) -> None:
        """Record a declaration that has no effect."""
        self.part.unsupported.append(Unsupported(topic, what, span))

    def infrastructure(self) -> None:
        """Read the infrastructure. Agents always share one process here."""
        token = self.cursor.token
        self.part.infrastructure.append(self.class_text())
        if token.text.lower() not in _OWN_INFRASTRUCTURES:
            self.unsupported(
                INFRASTRUCTURES, f"the infrastructure `{token.text}`", self.cursor.span_of(token)
            )

    def environment(self) -> None:
        """Read the class of the environment. A Java class has no effect."""
        token = self.cursor.token
        self.part.environment = self.class_text()
        name = self.part.environment.partition("(")[0]
        if name not in CARTAGO_ENVIRONMENTS:
            self.unsupported(JAVA_ENVIRONMENT, f"the environment `{name}`", self.cursor.span_of(token))

    def no_section(self) -> NoReturn:
        token = self.cursor.token
        help = suggestion(token.text, _SECTIONS, f"expected one of {', '.join(_SECTIONS)}")
        self.cursor.fail(f"unknown section {token} in a .mas2j file", help=help)

    def to_next_section(self, start: int) -> None:
        """Skip to the next section or the end, after an error in the section that began at *start*."""
        if self.cursor.index == start:
            self.cursor.advance()
        while self.cursor.token.kind != "end" and not self.at_section_or_end():
            self.cursor.advance()

    def at_section_or_end(self) -> bool:
        token = self.cursor.token
        return token.kind == "}" or (token.text in _SECTIONS and self.cursor.at_key())

    def value(self, what: str) -> Token:
        if self.cursor.token.kind not in ("string", "word", "number"):
            self.cursor.fail(f"expected {what}, found {self.cursor.token}")
        return self.cursor.advance()

    def class_text(self) -> str:
        """Return a class with its arguments, as written, without a following ``at "host"``."""
        name = self.cursor.name("a class name").text
        text = name + self.parameters()
        at = self.cursor.token
        if self.cursor.accept("at"):
            host = self.value("the name of a host")
            self.unsupported(NODES, f"`at {text_of(host)}`", self.cursor.span_of(at))
        self.cursor.accept(";")
        return text

    def parameters(self) -> str:
        if self.cursor.token.kind != "(":
            return ""
        start = self.cursor.token.start
        self.cursor.skip_block()
        return self.cursor.file.text[start : self.cursor.tokens[self.cursor.index - 1].stop]

    def source_path(self) -> None:
        while self.cursor.token.kind in ("string", "word") and not self.at_section_or_end():
            self.part.source_paths.append(text_of(self.cursor.advance()))
            if not (self.cursor.accept(";") or self.cursor.accept(",")):
                break

    # agents

    def agents(self) -> None:
        if self.at_section_or_end():
            self.cursor.report("expected at least one agent")
        while not self.at_section_or_end() and self.cursor.token.kind != "end":
            try:
                self.agent()
            except ProjectPanic:
                self.to_next_agent()

    def to_next_agent(self) -> None:
        """Skip to the token after the next ';', after an error."""
        while self.cursor.token.kind != "end" and not self.at_section_or_end():
            if self.cursor.advance().kind == ";":
                return

    def agent(self) -> None:
        cursor = self.cursor
        if cursor.at_key():
            self.no_section()
        name = cursor.lower_name("the name of an agent")
        agent = AgentPart(name.text, cursor.span_of(name))
        if cursor.token.kind in ("word", "string") and cursor.token.text not in _AGENT_KEYS:
            self.refuse_misspelt_key()
            self.source(agent)
        if cursor.token.kind == "[":
            self.options(agent)
        while cursor.token.kind != ";":
            self.agent_part(agent)
        cursor.advance()
        self.part.agents.append(agent)

    def refuse_misspelt_key(self) -> None:
        """Report a word before a class that is nearly a key. Otherwise it would be read as the agent's file."""
        cursor = self.cursor
        written = cursor.token.text.lower()
        meant = [key for key in _AGENT_KEYS if key.lower() == written]
        if not meant and cursor.peek().kind == "word":
            meant = [key for key in _AGENT_KEYS[:3] if is_slip_of(written, key.lower())]
        if meant and cursor.token.kind == "word":
            cursor.fail(f"unexpected {cursor.token}", help=did_you_mean(meant[:1]))

    def source(self, agent: AgentPart) -> None:
        token = self.cursor.advance()
        if token.first and token.kind == "word" and "/" not in token.text and "." not in token.text:
            # A file name may be on a line of its own, but then it must look like one.
            self.cursor.report(
                f"missing `;` after agent `{agent.name}`",
                self.cursor.span_of(token),
                "end each agent with `;`",
            )
            return
        agent.source, agent.source_span = text_of(token), self.cursor.span_of(token)

    def agent_part(self, agent: AgentPart) -> None:
        cursor = self.cursor
        key = cursor.token
        if cursor.accept("#"):
            agent.instances = self.count()
            return
        if key.text not in _AGENT_KEYS or key.kind != "word":
            end = "end each agent with `;`"
            help = suggestion(key.text, _AGENT_KEYS, end) if key.kind == "word" else end
            cursor.fail(f"expected `;` after agent `{agent.name}`, found {key}", help=help)
        cursor.advance()
        if key.text == "at":
            agent.host = text_of(self.value("the name of a host"))
            self.unsupported(NODES, f"`at` of agent `{agent.name}`", cursor.span_of(key))
            return
        if key.text == "agentClass":
            agent.agent_class = cursor.name("a class name").text + self.parameters()
            return
        self.class_without_effect(key.text)
        while key.text == "agentArchClass" and cursor.accept(","):
            self.class_without_effect(key.text)

    def class_without_effect(self, key: str) -> None:
        name = self.cursor.name("a class name")
        self.parameters()
        found = class_without_effect(key, name.text)
        if found is not None:
            self.unsupported(*found, self.cursor.span_of(name))

    def count(self) -> int:
        token = self.value("a number of agents")
        if token.kind != "number" or not token.text.isdecimal() or not 0 < len(token.text.lstrip("0")) < 7:
            self.cursor.fail(
                f"expected a positive number of agents, found {token}",
                self.cursor.span_of(token),
                "write `#3`",
            )
        return int(token.text)

    def options(self, agent: AgentPart) -> None:
        cursor = self.cursor
        opener = cursor.advance()
        while not cursor.accept("]"):
            if cursor.token.kind == "end":
                cursor.fail("`[` is not closed", cursor.span_of(opener))
            key = cursor.name("the name of an option")
            cursor.expect("=", "write options as `[verbose=2, events=discard]`")
            value = self.value(f"the value of `{key.text}`")
            text = text_of(value) + self.parameters()
            if key.text == "beliefs":
                agent.beliefs.append((text, cursor.span_of(value)))
            elif key.text == "goals":
                agent.goals.append((text, cursor.span_of(value)))
            else:
                agent.options[key.text] = text
                agent.option_places[key.text] = cursor.span_of(value)
            if cursor.token.kind != "]":
                cursor.expect(",", "separate options with `,`")
