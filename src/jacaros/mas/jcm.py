"""`.jcm` project files.

Accepted beyond the reference: sections in any order, blocks on one line, negative and boolean parameters of
artifacts, ``parent:`` of workspaces and ``world:``.
"""

from collections.abc import Callable
from contextlib import suppress
from typing import Final

from jacaros.mas.deployment import ArtifactSpec
from jacaros.mas.jcm_values import NAME, SECTIONS, JcmValues
from jacaros.mas.project_cursor import ProjectCursor, ProjectPanic, Token, text_of
from jacaros.mas.project_parts import (
    AgentName,
    AgentPart,
    ArtifactPart,
    FocusPart,
    ProjectPart,
    WorkspacePart,
)

_KEYS: Final = ("asl-path", "org-path", "java-path", "class-path", "platform", "world")


def read_jcm(cursor: ProjectCursor) -> ProjectPart:
    """The declarations of a `.jcm` file; errors are left in the cursor."""
    part = ProjectPart()
    with suppress(ProjectPanic):
        _JcmReader(cursor, part).project()
    return part


class _JcmReader(JcmValues):
    def __init__(self, cursor: ProjectCursor, part: ProjectPart) -> None:
        super().__init__(cursor)
        self.part = part

    # the file

    def project(self) -> None:
        cursor = self.cursor
        cursor.expect("mas", "a .jcm file begins with mas name {")
        self.part.name = cursor.lower_name("the name of the system").text
        if cursor.accept("uses"):
            while cursor.token.kind in NAME:
                file = cursor.advance()
                self.part.uses.append((text_of(file), cursor.span_of(file)))
                cursor.accept(",")
        opener = cursor.expect("{")
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("'{' is not closed", cursor.span_of(opener), "the file ends with }")
            try:
                self.section()
            except ProjectPanic:
                self.to_next_section()
                if cursor.token.kind == "end":
                    return  # nothing of the file's own '}' is known: the error may have swallowed it

    def section(self) -> None:
        cursor = self.cursor
        token = cursor.token
        if token.text in _KEYS and cursor.at_key():
            cursor.advance()
            cursor.advance()
            self.line(token)
        elif token.text not in SECTIONS:
            cursor.fail(
                f"'{token.text}' is no section of a .jcm file",
                hint=f"the sections are {', '.join((*SECTIONS[:4], *_KEYS))}",
            )
        elif token.text == "agent":
            self.agent()
        elif token.text == "workspace":
            self.workspace()
        else:
            self.unsupported()

    def to_next_section(self) -> None:
        """After an error: to the next section on a line of its own."""
        while self.cursor.token.kind != "end":
            token = self.cursor.token
            if token.first and (token.text in SECTIONS or (token.text in _KEYS and self.cursor.at_key())):
                return
            self.cursor.advance()

    def line(self, key: Token) -> None:
        """The value of a key of the whole project."""
        cursor = self.cursor
        if key.text == "asl-path":
            self.part.source_paths += [text for text, _ in self.names()]
        elif key.text == "world":
            if cursor.token.kind not in NAME:
                cursor.fail("the name of a world file is expected")
            self.part.world = text_of(cursor.advance())
        elif key.text == "platform":
            self.part.infrastructure += [text for text, _ in self.pieces()]
        else:
            self.names()

    def unsupported(self) -> None:
        """Organisations, institutions, nodes and packages are read over."""
        cursor = self.cursor
        key = cursor.advance()
        span = cursor.span_of(key)
        while cursor.token.kind not in ("{", "}", "end") and not cursor.token.first:
            cursor.advance()
        if cursor.token.kind == "{":
            cursor.skip_block()
        what = {"node": "distribution over nodes", "uses": "Java packages", "institution": "institutions"}
        cursor.warn(f"{what.get(key.text, 'organisations')} are not supported and have no effect", span)

    # agents

    def agent(self) -> None:
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name("the name of an agent")
        agent = AgentPart(name.text, cursor.span_of(name))
        if cursor.accept(":"):
            if cursor.token.kind not in NAME:
                cursor.fail("the file of the agent is expected")
            agent.source = text_of(cursor.advance())
        self.part.agents.append(agent)
        if cursor.token.kind == "{":
            self.block(lambda key: self.agent_key(agent, key))

    def block(self, read: Callable[[Token], None]) -> None:
        """``{ key: value ... }``; *read* reads the value of one key."""
        cursor = self.cursor
        opener = cursor.advance()
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("'{' is not closed", cursor.span_of(opener))
            if cursor.token.text in SECTIONS and cursor.token.first and not cursor.at_key():
                cursor.fail("'{' is not closed", cursor.span_of(opener), "put a '}' before the next section")
            if cursor.token.kind == "word" and not cursor.at_key():
                cursor.fail(f"a ':' is missing behind '{cursor.token.text}'")
            if not cursor.at_key():
                cursor.fail(f"'key:' is expected, not '{cursor.token.text}'")
            key = cursor.advance()
            cursor.advance()
            read(key)
            cursor.accept(",")

    def agent_key(self, agent: AgentPart, key: Token) -> None:
        cursor = self.cursor
        match key.text:
            case "beliefs":
                agent.beliefs += self.pieces()
            case "goals":
                agent.goals += self.pieces()
            case "join":
                agent.join += self.names()
            case "focus":
                self.focus(agent)
            case "instances":
                self.instances(agent)
            case "ag-class":
                agent.agent_class = " ".join(text for text, _ in self.pieces())
            case "ag-arch":
                agent.architecture_classes += [text for text, _ in self.pieces()]
            case "ag-bb-class":
                agent.belief_base_class = " ".join(text for text, _ in self.pieces())
            case "host":
                agent.host = " ".join(text for text, _ in self.pieces())
            case "roles":
                self.pieces()
                cursor.warn(
                    "roles in organisations are not supported and have no effect", cursor.span_of(key)
                )
            case _:
                agent.option_places[key.text] = cursor.span_of(key)
                agent.options[key.text] = ", ".join(text.strip('"') for text, _ in self.pieces())

    def instances(self, agent: AgentPart) -> None:
        values = self.names()
        if len(values) == 1 and values[0][0].isdigit() and int(values[0][0]) > 0:
            agent.instances = int(values[0][0])
        elif values and all(text[0].islower() for text, _ in values):
            agent.instances = [text for text, _ in values]
        else:
            self.cursor.report(
                "'instances' is a number or the names of agents", values[0][1] if values else agent.span
            )

    def focus(self, agent: AgentPart) -> None:
        for name, namespace, span in self.agent_names():
            workspace, dot, artifact = name.rpartition(".")
            agent.focus.append(FocusPart(artifact, workspace if dot else None, namespace, span))

    # workspaces

    def workspace(self) -> None:
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name("the name of a workspace")
        workspace = WorkspacePart(name.text, cursor.span_of(name))
        self.part.workspaces.append(workspace)
        if cursor.token.kind != "{":
            return
        opener = cursor.advance()
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("'{' is not closed", cursor.span_of(opener))
            self.workspace_entry(workspace)
            cursor.accept(",")

    def workspace_entry(self, workspace: WorkspacePart) -> None:
        cursor = self.cursor
        key = cursor.token
        if key.text == "artifact" and not cursor.at_key():
            self.artifact(workspace)
            return
        if key.text == "debug" and not cursor.at_key():
            cursor.advance()
            return
        if not cursor.at_key():
            cursor.fail(
                f"an artifact or a key is expected, not '{key.text}'", hint="artifact name : Class(arguments)"
            )
        cursor.advance()
        cursor.advance()
        if key.text == "agents":
            workspace.agents += self.names()
        elif key.text == "parent":
            workspace.parent = cursor.name("the name of a workspace").text
        else:
            self.names()
            cursor.warn(f"'{key.text}' of a workspace has no effect", cursor.span_of(key))

    def artifact(self, workspace: WorkspacePart) -> None:
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name("the name of an artifact")
        cursor.expect(":", "artifact name : Class(arguments)")
        if cursor.token.kind not in NAME:
            cursor.fail("the class of the artifact is expected")
        type_name = text_of(cursor.advance())
        arguments = self.arguments() if cursor.token.kind == "(" else ()
        focused_by: list[AgentName] = []
        if cursor.token.kind == "{":
            self.block(lambda key: self.artifact_key(key, focused_by))
        spec = ArtifactSpec(
            name.text, type_name, arguments, tuple(agent for agent, _, _ in focused_by), cursor.span_of(name)
        )
        workspace.artifacts.append(ArtifactPart(spec, focused_by))

    def artifact_key(self, key: Token, focused_by: list[AgentName]) -> None:
        if key.text == "focused-by":
            focused_by += self.agent_names()
        else:
            self.pieces()
            self.cursor.warn(f"'{key.text}' of an artifact has no effect", self.cursor.span_of(key))
