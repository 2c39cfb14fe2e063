"""`.mas2j` project files."""

from contextlib import suppress
from typing import Final, NoReturn

from jacaros.mas.deployment import CARTAGO_ENVIRONMENTS
from jacaros.mas.project_cursor import ProjectCursor, ProjectPanic, Token, text_of
from jacaros.mas.project_parts import AgentPart, ProjectPart

_SECTIONS: Final = (
    "infrastructure",
    "environment",
    "executionControl",
    "agents",
    "directives",
    "classpath",
    "aslSourcePath",
    "world",
)
_AGENT_KEYS: Final = frozenset({"agentArchClass", "agentClass", "beliefBaseClass", "at"})


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
        opener = cursor.expect("{")
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("'{' is not closed", cursor.span_of(opener), "the file ends with }")
            try:
                self.section()
            except ProjectPanic:
                self.to_next_section()

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
                self.part.world = text_of(self.value("the name of a world file"))
                cursor.accept(";")
            case "environment":
                self.environment()
            case "infrastructure":
                self.part.infrastructure.append(self.class_text())
            case _:
                span = cursor.span_of(key)
                cursor.raw(self.at_section_or_end)
                cursor.warn(f"'{key.text}' is about Java code and has no effect", span)

    def environment(self) -> None:
        """The class of the environment; one of Java has no effect."""
        token = self.cursor.token
        self.part.environment = self.class_text()
        name = self.part.environment.partition("(")[0]
        if name not in CARTAGO_ENVIRONMENTS:
            self.cursor.warn(
                f"the Java environment {name} has no effect",
                self.cursor.span_of(token),
                "write it as an artifact in Python, and here: environment: jacaros.Environment",
            )

    def no_section(self) -> NoReturn:
        what = self.cursor.token.text
        hint = f"the sections are {', '.join(_SECTIONS)}"
        self.cursor.fail(f"'{what}' is no section of a .mas2j file", hint=hint)

    def to_next_section(self) -> None:
        """After an error: to the next section or the end."""
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
        if self.cursor.accept("at"):
            self.value("the name of a host")
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
            self.source(agent)
        if cursor.token.kind == "[":
            self.options(agent)
        while cursor.token.kind != ";":
            self.agent_part(agent)
        cursor.advance()
        self.part.agents.append(agent)

    def source(self, agent: AgentPart) -> None:
        token = self.cursor.advance()
        agent.source = text_of(token)
        if token.first:
            self.cursor.report(
                f"a ';' is missing behind the agent '{agent.name}'",
                self.cursor.span_of(token),
                "each agent of the list ends with ';'",
            )

    def agent_part(self, agent: AgentPart) -> None:
        cursor = self.cursor
        key = cursor.token
        if cursor.accept("#"):
            agent.instances = self.count()
            return
        if key.text not in _AGENT_KEYS or key.kind != "word":
            cursor.fail(
                f"a ';' is expected behind the agent '{agent.name}'",
                hint="each agent of the list ends with ';'",
            )
        cursor.advance()
        if key.text == "at":
            agent.host = text_of(self.value("the name of a host"))
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
        if token.kind != "number" or not token.text.isdigit() or int(token.text) < 1:
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
