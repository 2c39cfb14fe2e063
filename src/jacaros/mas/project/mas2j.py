"""`.mas2j` project files."""

from contextlib import suppress
from typing import Final, NoReturn

from jacaros.asl.slips import close_matches
from jacaros.asl.source import Span
from jacaros.mas.deployment import CARTAGO_ENVIRONMENTS
from jacaros.mas.project.cursor import ProjectCursor, ProjectPanic, Token, text_of
from jacaros.mas.project.parts import AgentPart, ProjectPart
from jacaros.mas.project.unsupported import INFRASTRUCTURES, JAVA, JAVA_ENVIRONMENT, NODES, Topic, Unsupported

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
"""Infrastructures whose work is done here anyway, in lower case."""


def read_mas2j(cursor: ProjectCursor) -> ProjectPart:
    """The declarations of a `.mas2j` file; errors are left in the cursor."""
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
        cursor.expect("MAS", "a .mas2j file begins with MAS name {")
        self.part.name = cursor.name("the name of the system").text
        opener = cursor.expect("{", "the head of a .mas2j file is: MAS name {")
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("'{' is not closed", cursor.span_of(opener), "the file ends with }")
            start = cursor.index
            try:
                self.section()
            except ProjectPanic:
                self.to_next_section(start)
                if cursor.token.kind == "end":
                    return  # nothing of the file's own '}' is known: the error may have swallowed it
        if cursor.token.kind != "end":
            cursor.report(
                f"{cursor.token} after the end of the system",
                help="there may be an extra '}' before it",
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
                self.unsupported(JAVA, f"'{key.text}'", span)

    def unsupported(self, topic: Topic, what: str, span: Span) -> None:
        """Record something that has no effect here."""
        self.part.unsupported.append(Unsupported(topic, what, span))

    def infrastructure(self) -> None:
        """How the agents are run; here they always share one process."""
        token = self.cursor.token
        self.part.infrastructure.append(self.class_text())
        if token.text.lower() not in _OWN_INFRASTRUCTURES:
            self.unsupported(INFRASTRUCTURES, f"the infrastructure {token.text}", self.cursor.span_of(token))

    def environment(self) -> None:
        """The class of the environment; one of Java has no effect."""
        token = self.cursor.token
        self.part.environment = self.class_text()
        name = self.part.environment.partition("(")[0]
        if name not in CARTAGO_ENVIRONMENTS:
            self.unsupported(JAVA_ENVIRONMENT, f"the environment {name}", self.cursor.span_of(token))

    def no_section(self) -> NoReturn:
        token = self.cursor.token
        close = close_matches(token.text, _SECTIONS)
        help = f"did you mean '{close[0]}'?" if close else f"the sections are {', '.join(_SECTIONS)}"
        self.cursor.fail(f"unknown section {token} of a .mas2j file", help=help)

    def to_next_section(self, start: int) -> None:
        """After an error in the section that began at *start*: to the next one or the end."""
        if self.cursor.index == start:
            self.cursor.advance()
        while self.cursor.token.kind != "end" and not self.at_section_or_end():
            self.cursor.advance()

    def at_section_or_end(self) -> bool:
        token = self.cursor.token
        return token.kind == "}" or (token.text in _SECTIONS and self.cursor.at_key())

    def value(self, what: str) -> Token:
        if self.cursor.token.kind not in ("string", "word", "number"):
            self.cursor.fail(f"{what} is expected")
        return self.cursor.advance()

    def class_text(self) -> str:
        """A class with its parameters, as written; ``at "host"`` behind it is left out."""
        name = self.cursor.name("a class name").text
        text = name + self.parameters()
        at = self.cursor.token
        if self.cursor.accept("at"):
            host = self.value("the name of a host")
            self.unsupported(NODES, f"'at {text_of(host)}'", self.cursor.span_of(at))
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
            self.cursor.report("no agent is declared")
        while not self.at_section_or_end() and self.cursor.token.kind != "end":
            try:
                self.agent()
            except ProjectPanic:
                self.to_next_agent()

    def to_next_agent(self) -> None:
        """After an error: behind the next ';'."""
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
        """Blame a word before a class that is nearly a key: it would be taken for the file of the agent."""
        cursor = self.cursor
        meant = [key for key in _AGENT_KEYS if key.lower() == cursor.token.text.lower()]
        meant = meant or (
            close_matches(cursor.token.text, _AGENT_KEYS[:3], 0.8) if cursor.peek().kind == "word" else []
        )
        if meant and cursor.token.kind == "word":
            cursor.fail(f"{cursor.token} does not belong here", help=f"did you mean '{meant[0]}'?")

    def source(self, agent: AgentPart) -> None:
        token = self.cursor.advance()
        if token.first and token.kind == "word" and "/" not in token.text and "." not in token.text:
            # A file may stand on a line of its own, but then it looks like a file.
            self.cursor.report(
                f"a ';' is missing behind the agent '{agent.name}'",
                self.cursor.span_of(token),
                "each agent of the list ends with ';'",
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
            close = close_matches(key.text, _AGENT_KEYS) if key.kind == "word" else []
            help = f"did you mean '{close[0]}'?" if close else "each agent of the list ends with ';'"
            cursor.fail(f"a ';' is expected behind the agent '{agent.name}'", help=help)
        cursor.advance()
        if key.text == "at":
            agent.host = text_of(self.value("the name of a host"))
            self.unsupported(NODES, f"'at' of agent '{agent.name}'", cursor.span_of(key))
            return
        name = cursor.name("a class name")
        text = name.text + self.parameters()
        if key.text == "agentArchClass":
            agent.architecture_classes.append(text)
            while cursor.accept(","):
                agent.architecture_classes.append(cursor.name("a class name").text + self.parameters())
        elif key.text == "agentClass":
            agent.agent_class = text
        else:
            agent.belief_base_class = text

    def count(self) -> int:
        token = self.value("a number of agents")
        if token.kind != "number" or not token.text.isdecimal() or not 0 < len(token.text.lstrip("0")) < 7:
            self.cursor.fail("the number of agents is a whole number", self.cursor.span_of(token), "as in #3")
        return int(token.text)

    def options(self, agent: AgentPart) -> None:
        cursor = self.cursor
        opener = cursor.advance()
        while not cursor.accept("]"):
            if cursor.token.kind == "end":
                cursor.fail("'[' is not closed", cursor.span_of(opener))
            key = cursor.name("the name of an option")
            cursor.expect("=", "options are written [verbose=2, events=discard]")
            value = self.value(f"the value of '{key.text}'")
            text = text_of(value) + self.parameters()
            if key.text == "beliefs":
                agent.beliefs.append((text, cursor.span_of(value)))
            elif key.text == "goals":
                agent.goals.append((text, cursor.span_of(value)))
            else:
                agent.options[key.text] = text
                agent.option_places[key.text] = cursor.span_of(value)
            if cursor.token.kind != "]":
                cursor.expect(",", "options are separated by ','")
