"""Workspaces and artifacts in `.jcm` project files."""

from typing import Final

from jacaros.mas.deployment import ArtifactSpec
from jacaros.mas.project.cursor import text_of
from jacaros.mas.project.jcm_values import NAME, JcmValues
from jacaros.mas.project.parts import AgentName, ArtifactPart, WorkspacePart
from jacaros.mas.project.unsupported import INSPECTORS, NODES

ENTRIES: Final = ("artifact", "debug")
_KEYS: Final = ("agents", "parent", "host", "node", "debug")


class JcmWorkspaces(JcmValues):
    """Reads ``workspace name { ... }``."""

    def workspace(self) -> None:
        """Read one workspace. The cursor is on ``workspace``."""
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name("the name of a workspace")
        workspace = WorkspacePart(name.text, cursor.span_of(name))
        self.part.workspaces.append(workspace)
        if cursor.token.kind == "{":
            self.block(lambda: self._entry(workspace))

    def _entry(self, workspace: WorkspacePart) -> None:
        cursor = self.cursor
        token = cursor.token
        if token.text == "artifact" and not cursor.at_key():
            self._artifact(workspace)
            return
        span = cursor.span_of(token)
        if token.text == "debug" and not cursor.at_key():
            cursor.advance()
            self.unsupported(INSPECTORS, f"`debug` of workspace `{workspace.name}`", span)
            return
        if token.kind == "word" and cursor.peek().kind == "word" and not cursor.at_key():
            cursor.fail(
                f"expected an artifact or a key, found {token}",
                help="write `artifact name : Class(arguments)`",
            )
        key = self.key(_KEYS, "a workspace")
        match key.text:
            case "agents":
                workspace.agents += self.names()
            case "parent":
                parent = cursor.name("the name of a workspace")
                workspace.parent, workspace.parent_span = parent.text, cursor.span_of(parent)
            case "host" | "node":
                cursor.name("the name of a node")
                self.unsupported(NODES, f"`{key.text}` of workspace `{workspace.name}`", span)
            case "debug":
                self.pieces()
                self.unsupported(INSPECTORS, f"`debug` of workspace `{workspace.name}`", span)
            case _:
                self.unknown_key(key, ("artifact", *_KEYS), "a workspace")

    def _artifact(self, workspace: WorkspacePart) -> None:
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name("the name of an artifact")
        # Add it now: if the rest has an error, references to the artifact are still valid.
        part = ArtifactPart(ArtifactSpec(name.text, "", span=cursor.span_of(name)))
        workspace.artifacts.append(part)
        cursor.expect(":", "write `artifact name : Class(arguments)`")
        if cursor.token.kind not in NAME:
            cursor.fail(
                f"expected the class of the artifact, found {cursor.token}",
                help="write `artifact name : Class(arguments)`",
            )
        type_token = cursor.advance()
        arguments = self.arguments() if cursor.token.kind == "(" else ()
        focused_by: list[AgentName] = []
        if cursor.token.kind == "{":
            entries, self.entries = self.entries, ()
            try:
                self.block(lambda: self._artifact_entry(focused_by))
            finally:
                self.entries = entries
        agents = tuple(agent for agent, _, _ in focused_by)
        spans = cursor.span_of(name), cursor.span_of(type_token)
        part.spec = ArtifactSpec(name.text, text_of(type_token), arguments, agents, *spans)
        part.focused_by = focused_by

    def _artifact_entry(self, focused_by: list[AgentName]) -> None:
        key = self.key(("focused-by",), "an artifact")
        if key.text == "focused-by":
            focused_by += self.agent_names()
        else:
            self.unknown_key(key, ("focused-by",), "an artifact")
