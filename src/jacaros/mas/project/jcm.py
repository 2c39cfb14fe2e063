"""`.jcm` project files.

Beyond JaCaMo's grammar they accept sections in any order, blocks on one line, negative and boolean arguments of artifacts,
lists and structures as arguments, ``parent:`` of workspaces, paths as names of workspaces, ``world:`` and ``mapping:``.
"""

from contextlib import suppress
from typing import Final

from jacaros.files.texts import suggestion
from jacaros.mas.project.cursor import ProjectCursor, ProjectPanic, Token, UnclosedPanic, text_of
from jacaros.mas.project.jcm_agents import KEYS as AGENT_KEYS
from jacaros.mas.project.jcm_agents import JcmAgents
from jacaros.mas.project.jcm_organisations import JcmOrganisations
from jacaros.mas.project.jcm_values import NAME, SECTIONS, JcmValues
from jacaros.mas.project.jcm_workspaces import ENTRIES, JcmWorkspaces
from jacaros.mas.project.parts import ProjectPart, Written
from jacaros.mas.project.unsupported import NODES, PACKAGES, PATHS, PLATFORMS

_KEYS: Final = ("asl-path", "org-path", "java-path", "class-path", "platform", "world", "mapping")
_OWN_PLATFORMS: Final = ("cartago", "local", "centralised", "jacamo.platform.Cartago")
"""Platforms that JaCaROS replaces, so they need no warning."""


def read_jcm(cursor: ProjectCursor) -> ProjectPart:
    """Return the declarations of a `.jcm` file. Errors are collected in the cursor."""
    part = ProjectPart()
    with suppress(ProjectPanic):
        _JcmReader(cursor, part).project()
    return part


class _JcmReader(JcmValues):
    def __init__(self, cursor: ProjectCursor, part: ProjectPart) -> None:
        super().__init__(cursor, part)
        self.agents = JcmAgents(cursor, part, keys=AGENT_KEYS)
        self.workspaces = JcmWorkspaces(cursor, part, ENTRIES)
        self.organisations = JcmOrganisations(cursor, part)

    def project(self) -> None:
        cursor = self.cursor
        cursor.expect("mas", "begin the file with `mas name {`")
        self.part.name = cursor.lower_name("the name of the system").text
        if cursor.accept("uses"):
            while cursor.token.kind in NAME:
                self.part.uses.append(self.file_name("a project file"))
                cursor.accept(",")
        opener = cursor.expect("{", "begin the file with `mas name {`")
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("`{` is not closed", cursor.span_of(opener), "end the file with `}`")
            start = cursor.index
            try:
                self._section()
            except UnclosedPanic:
                if cursor.token.kind == "end":
                    return  # the error may have consumed the closing bracket of the file
            except ProjectPanic:
                self._to_next_section(start)
                if cursor.token.kind == "end":
                    return
        if cursor.token.kind != "end":
            cursor.report(
                f"unexpected {cursor.token} after the end of the system",
                help="check for an extra `}` before it",
            )

    def _section(self) -> None:
        cursor = self.cursor
        token = cursor.token
        if token.text in _KEYS and cursor.at_key():
            cursor.advance()
            cursor.advance()
            self._line(token)
            return
        match token.text if token.kind == "word" and not cursor.at_key() else "":
            case "agent":
                self.agents.agent()
            case "workspace":
                self.workspaces.workspace()
            case "organisation" | "organization":
                self.organisations.organisation()
            case "institution":
                self.organisations.institution()
            case "node":
                self._node()
            case "uses":
                self._package()
            case _:
                self._no_section(token)

    def _no_section(self, token: Token) -> None:
        sections = (*SECTIONS[:4], *_KEYS)
        help = suggestion(token.text, sections, f"expected one of {', '.join(sections)}")
        self.cursor.fail(f"unknown section {token} in a .jcm file", help=help)

    def _to_next_section(self, start: int) -> None:
        """Skip to the next section at the beginning of a line, after an error in the one that began at *start*."""
        cursor = self.cursor
        if cursor.index == start:
            cursor.advance()
        while cursor.token.kind != "end":
            token = cursor.token
            if token.first and (self.at_section() or (token.text in _KEYS and cursor.at_key())):
                return
            cursor.advance()

    def _line(self, key: Token) -> None:
        """Read the value of a key of the project."""
        cursor = self.cursor
        if key.text == "asl-path":
            self.part.source_paths += [text for text, _ in self._some(key)]
        elif key.text == "java-path":
            self.part.code_paths += [text for text, _ in self._some(key)]
        elif key.text == "world":
            if cursor.token.kind not in NAME:
                cursor.fail(f"expected the name of a world file, found {cursor.token}")
            name = cursor.advance()
            self.part.world, self.part.world_span = text_of(name), cursor.span_of(name)
        elif key.text == "mapping":
            self.part.mappings += self._some(key)
        elif key.text == "platform":
            self._platforms(key)
        else:
            self._some(key)
            self.unsupported(PATHS, f"`{key.text}`", cursor.span_of(key))

    def _some(self, key: Token) -> list[Written]:
        """Return at least one name."""
        found = self.names()
        if not found:
            self.cursor.fail(f"expected a value after `{key.text}:`, found {self.cursor.token}")
        return found

    def _platforms(self, key: Token) -> None:
        found = self.classes()
        if not found:
            self.cursor.fail(f"expected a platform after `{key.text}:`, found {self.cursor.token}")
        for text, span in found:
            self.part.infrastructure.append(text)
            name, _, parameters = text.partition("(")
            switched_off = parameters.strip('") ') == "false"
            if name.strip() not in _OWN_PLATFORMS and not switched_off:
                self.unsupported(PLATFORMS, f"the platform `{name}`", span)

    def _node(self) -> None:
        """``node name [running] [@ host[:port]]``."""
        cursor = self.cursor
        cursor.advance()
        name = cursor.name("the name of a node")
        cursor.accept("running")
        if cursor.accept("@"):
            self.file_name("the address of the node")
        self.unsupported(NODES, f"the node `{name.text}`", cursor.span_of(name))

    def _package(self) -> None:
        """``uses package: name "file or coordinates"``."""
        cursor = self.cursor
        cursor.advance()
        cursor.expect("package", 'write `uses package: name "file.jar"`')
        cursor.expect(":", 'write `uses package: name "file.jar"`')
        name = cursor.name("the name of the package")
        if cursor.token.kind == "string":
            cursor.advance()
        self.unsupported(PACKAGES, f"the package `{name.text}`", cursor.span_of(name))
