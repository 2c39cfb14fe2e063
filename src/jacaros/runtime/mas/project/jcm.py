"""`.jcm` project files.

Beyond JaCaMo's grammar they accept sections in any order, blocks on one line, negative and boolean arguments of artifacts,
lists and structures as arguments, ``parent:`` of workspaces, paths as names of workspaces, ``world:`` and ``mapping:``.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Final

from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.files.texts import did_you_mean, suggestion
from jacaros.runtime.mas.deployment import ArtifactSpec, NodeSpec
from jacaros.runtime.mas.project.cursor import ProjectPanic, ProjectToken, UnclosedPanic, text_of
from jacaros.runtime.mas.project.declarations import (
    INSPECTORS,
    INSTITUTIONS,
    ORGANISATIONS,
    PACKAGES,
    PATHS,
    PLATFORMS,
    ROLES,
    AgentName,
    AgentPart,
    ArtifactDeclaration,
    FocusPart,
    JoinPart,
    WorkspacePart,
    WrittenName,
)
from jacaros.runtime.mas.project.language import NAME, ProjectReader

_OWN_PLATFORMS: Final = ("cartago", "local", "centralised", "jacamo.platform.Cartago")
"""Platforms that JaCaROS replaces, so they need no warning."""
_ADDRESS: Final = re.compile(r"(\[[0-9a-fA-F:.]+\]|[\w.-]+)(:[0-9]{1,5})?")
"""``host`` or ``host:port``; an address of IPv6 is in brackets."""


@dataclass(frozen=True)
class Block:
    """What ``{ ... }`` may contain. The functions take the reader, the declaration with the block, and the first token.

    Attributes:
        what: what has the block, for messages.
        keys: by key, reads the value of ``key:``.
        entries: by keyword, reads an entry that begins with it.
        other: reads the value of another key. Default: report it and skip the value.
        is_strict: whether a key without ``:`` ends the value before it, and text after a value is an error.
    """

    what: str
    keys: "Mapping[str, Callable[[JcmReader, Any, ProjectToken], object]]"
    entries: "Mapping[str, Callable[[JcmReader, Any, ProjectToken], object]]" = field(default_factory=dict)
    other: "Callable[[JcmReader, Any, ProjectToken], object] | None" = None
    is_strict: bool = False


class JcmReader(ProjectReader):
    """Reads a `.jcm` file. A value ends before the next key, entry, section or closing bracket."""

    keyword, kind = "mas", ".jcm"

    def __init__(self, file: SourceFile, diagnostics: list[Diagnostic]) -> None:
        super().__init__(file, diagnostics)
        self._block: Block | None = None
        """The block in which the cursor is."""

    def head(self) -> None:
        self.part.name = self.lower_name("the name of the system").text
        if self.accept("uses"):
            while self.token.kind in NAME:
                self.part.uses.append(self._file_name("a project file"))
                self.accept(",")

    def other_section(self) -> None:
        token = self.token
        read = None if self.at_key() else _SECTIONS.get(token.text)
        if read is None:
            super().other_section()
        else:
            self.advance()
            read(self, token)

    def at_next_section(self) -> bool:
        return self.token.first and (self._at_section() or self.at_key_of_project())

    # ---- where things end

    def _at_section(self) -> bool:
        """Return whether a section begins here. Inside a block, a section must begin a line."""
        token = self.token
        if token.kind != "word" or token.text not in _SECTIONS or self.peek().kind != "word":
            return False
        return token.first or self._block is None

    def _at_entry(self) -> bool:
        """Return whether a key or an entry of the block begins here."""
        block = self._block
        token, following = self.token, self.peek()
        if self.at_key():
            return True
        if token.kind != "word" or block is None:
            return False
        if block.is_strict and token.text in block.keys:
            # The ':' is missing.
            return token.first and following.kind in NAME and not following.first
        if token.text not in block.entries:
            return False
        if token.text == "debug":
            return following.first or following.kind not in NAME or self.peek(2).kind == ":"
        return following.kind == "word"

    def _at_end(self) -> bool:
        """Return whether a value ends before the current token."""
        return self.token.kind in ("}", "end") or self._at_entry() or self._at_section()

    # ---- blocks

    def _read_block(self, block: Block, declared: object) -> None:
        """Read ``{ ... }``, if it is there. After an error, continue with the next entry."""
        if self.token.kind != "{":
            return
        around, self._block = self._block, block
        try:
            with self.nested():
                self._entries(block, declared)
        finally:
            self._block = around

    def _entries(self, block: Block, declared: object) -> None:
        opener = self.advance()
        while not self.accept("}"):
            if self.token.kind == "end":
                self.fail_unclosed(opener)
            if self._at_section():
                self.fail_unclosed(opener, "add `}` before the next section")
            start = self.index
            try:
                self._entry(block, declared)
            except UnclosedPanic:
                raise
            except ProjectPanic:
                self._to_next_entry(start)
            self.accept(",")

    def _entry(self, block: Block, declared: object) -> None:
        token = self.token
        if token.text in block.entries and not self.at_key():
            self.advance()
            block.entries[token.text](self, declared, token)
            return
        self._refuse_missing_colon(block)
        if token.kind != "word":
            self.fail(f"expected a key, found `{token.text}`")
        self.advance()
        self.advance()
        read = block.keys.get(token.text, block.other)
        if read is not None:
            read(self, declared, token)
        else:
            known = [*(each for each in block.entries if each not in block.keys), *block.keys]
            help = suggestion(token.text, known, f"keys of {block.what}: {', '.join(known)}")
            self.report(f"unknown key `{token.text}` in {block.what}", self.span_of(token), help)
            self.pieces()
        if block.is_strict and self.token.kind not in ("}", "end", ",") and not self._at_end():
            self.fail(f"unexpected {self.token} in the value of `{token.text}`")

    def _refuse_missing_colon(self, block: Block) -> None:
        token = self.token
        if token.kind != "word" or self.at_key():
            return
        if "artifact" in block.entries and self.peek().kind == "word":
            self.fail(f"expected an artifact or a key, found {token}", help=_ARTIFACT)
        keys = [f"{each}:" for each in block.keys if each not in block.entries]
        listed = f"keys of {block.what}: {', '.join([*block.entries, *keys])}"
        help = listed if token.text in block.keys else suggestion(token.text, block.keys, listed)
        self.fail(f"missing `:` after `{token.text}`", help=help)

    def _to_next_entry(self, start: int) -> None:
        """Skip to the next entry at the beginning of a line, after an error in the one that began at *start*."""
        if self.index == start and self.token.kind != "}":
            self.advance()
        depth = 0
        while self.token.kind != "end":
            if self.token.first and (self._at_section() or (depth <= 0 and self._at_entry())):
                return
            if self.token.kind == "}" and depth <= 0:
                return
            depth += (self.token.kind == "{") - (self.token.kind == "}")
            self.advance()

    # ---- values

    def _items(self, *kinds: str) -> Iterator[ProjectToken]:
        """Yield the first token of each item of a value, separated by spaces, commas or line ends."""
        while self.token.kind in kinds and not self._at_end():
            yield self.advance()
            self.accept(",")

    def names(self, *_: object) -> list[WrittenName]:
        """Return names."""
        return [(text_of(token), self.span_of(token)) for token in self._items(*NAME, "number", "*")]

    def some_names(self, key: ProjectToken) -> list[WrittenName]:
        """Return at least one name."""
        found = self.names()
        if not found:
            self.fail(f"expected a value after `{key.text}:`, found {self.token}")
        return found

    def _classes(self, missing: str = "") -> list[WrittenName]:
        """Return classes with their arguments as written. Without any, fail if *missing* says what is expected."""
        found = [(text_of(token) + self.parameters(), self.span_of(token)) for token in self._items(*NAME)]
        if not found and missing:
            self.fail(f"expected {missing}, found {self.token}")
        return found

    def pieces(self, *_: object) -> list[WrittenName]:
        """Return the pieces of a value, separated by commas or line ends, as written."""
        found: list[WrittenName] = []
        while not self._at_end():
            start = self.token

            def ends(start: ProjectToken = start) -> bool:
                token = self.token
                return token.kind == "," or (token.first and token is not start) or self._at_end()

            text = self.raw(ends)
            if text:
                found.append((text, self.span_of(start)))
            if not self.accept(",") and self.token is start:
                self.fail(f"unexpected `{start.text}`")
        return found

    def _file_name(self, what: str) -> WrittenName:
        """Return the name of a file. Without quotes, it ends at a space."""
        first = last = self.take(what, *NAME)
        if first.kind == "string":
            return text_of(first), self.span_of(first)
        while self.token.start == last.stop and self.token.kind in (*NAME, ":", "number"):
            last = self.advance()
        return self.file.text[first.start : last.stop], self.span_of(first).to(self.span_of(last))

    def _node_after_at(self) -> WrittenName | None:
        """Read ``@ node`` after the name of something that may be at another node; None without it."""
        return self._node_name() if self.accept("@") else None

    def _node_name(self) -> WrittenName:
        name = self.take("the name of a node", *NAME)
        return text_of(name), self.span_of(name)

    def _arguments(self, closer: str = ")") -> tuple[object, ...]:
        """Return the values between the current bracket and its *closer*."""
        opener = self.advance()
        values: list[object] = []
        while not self.accept(closer):
            values.append(self._argument(opener))
            if self.token.kind != closer:
                self.expect(",", f"close the `{opener.kind}` in line {opener.line} with `{closer}`")
        return tuple(values)

    def _argument(self, opener: ProjectToken) -> object:
        """Return one value. A string remains a string even if it looks like a number."""
        token = self.token
        if token.kind == "[":
            with self.nested():
                return list(self._arguments("]"))
        if token.kind not in ("number", "word", "string", "quoted"):
            self.fail("expected a value", help=f"close the `{opener.kind}` in line {opener.line}")
        if token.kind == "word" and not (token.text[0].isalpha() or token.text[0] in "_$"):
            self.fail(f"expected a value, found `{token.text}`", help="write a number, or a string in quotes")
        self.advance()
        if token.kind == "number":
            return self.number(token)
        if token.kind == "string":
            return text_of(token)
        name = token.text.strip("'") if token.kind == "quoted" else token.text
        if token.kind == "word" and name in ("true", "false"):
            return name == "true"
        arguments: tuple[object, ...] = ()
        if self.token.kind == "(" and self.token.start == token.stop:
            with self.nested():
                arguments = self._arguments()
        return Structure(name, arguments) if arguments else Atom(name)

    # ---- the project

    def _java_path(self, key: ProjectToken) -> None:
        self.some_names(key)
        self.unsupported(PATHS, f"`{key.text}`", self.span_of(key))

    def _platforms(self, key: ProjectToken) -> None:
        for text, span in self._classes(f"a platform after `{key.text}:`"):
            name, _, parameters = text.partition("(")
            switched_off = parameters.strip('") ') == "false"
            if name.strip() not in _OWN_PLATFORMS and not switched_off:
                self.unsupported(PLATFORMS, f"the platform `{name}`", span)

    def _node(self, _: ProjectToken) -> None:
        """``node name [running] [@ host[:port]]``, or ``at`` instead of ``@``."""
        name, span = self._node_name()
        self.accept("running")
        address = None
        if self.accept("@") or self.accept("at"):
            address, place = self._file_name("the address of the node")
            if _ADDRESS.fullmatch(address) is None:
                self.report(f"invalid address `{address}`", place, "write `host` or `host:port`")
        self.part.nodes.append(NodeSpec(name, address, span))

    def _package(self, _: ProjectToken) -> None:
        """``uses package: name "file or coordinates"``."""
        self.expect("package", 'write `uses package: name "file.jar"`')
        self.expect(":", 'write `uses package: name "file.jar"`')
        name = self.name("the name of the package")
        if self.token.kind == "string":
            self.advance()
        self.unsupported(PACKAGES, f"the package `{name.text}`", self.span_of(name))

    # ---- agents

    def _agent(self, _: ProjectToken) -> None:
        """``agent name : file { ... }``."""
        name = self.lower_name("the name of an agent")
        agent = AgentPart(name.text, self.span_of(name))
        if self.accept(":"):
            agent.source, agent.source_span = self._file_name("the file of the agent")
        self.part.agents.append(agent)
        if self.token.kind != "{" and not (self.token.first or self._at_end()):
            self.fail(
                f"unexpected {self.token} after agent `{agent.name}`",
                help="write `agent name : file.asl { ... }`, with quotes around a file name with spaces",
            )
        self._read_block(_AGENT, agent)

    def _join(self, agent: AgentPart, _: ProjectToken) -> None:
        for token in self._items(*NAME):
            agent.join.append(JoinPart(text_of(token), self.span_of(token), self._node_after_at()))

    def _focus(self, agent: AgentPart, _: ProjectToken) -> None:
        for first in self._items("word"):
            token, namespace = first, None
            if self.accept("::"):
                namespace, token = token.text, self.name("the name of an artifact")
            workspace, dot, artifact = token.text.rpartition(".")
            span = self.span_of(first).to(self.span_of(token))
            node = self._node_after_at()
            agent.focus.append(FocusPart(artifact, workspace if dot else None, namespace, span, node))

    def _instances(self, agent: AgentPart, key: ProjectToken) -> None:
        values = self.names()
        text = values[0][0] if values else ""
        if len(values) == 1 and text.isdecimal() and 0 < len(text) < 7 and int(text) > 0:
            agent.instances = int(text)
        elif values and all(text[:1].islower() for text, _ in values):
            agent.instances = [text for text, _ in values]
        else:
            span = values[0][1] if values else self.span_of(key)
            self.report("expected a number or names of agents as `instances`", span)

    def _roles(self, agent: AgentPart, _: ProjectToken) -> None:
        """``role in [organisation.]group [@ node]``, any number of times."""
        for role in self._items("word"):
            self.expect("in", "write `role in organisation.group`")
            group = self.name("the name of a group")
            span = self.span_of(role).to(self.span_of(group))
            self.unsupported(ROLES, f"the role `{role.text}` in `{group.text}`", span)
            self._node_after_at()

    def _class(self, agent: AgentPart, key: ProjectToken) -> None:
        found = self._classes(f"the class for `{key.text}`")
        if len(found) > 1 or agent.agent_class is not None:
            self.report(f"duplicate key `{key.text}`: an agent has only one", found[-1][1])
        agent.agent_class = found[0][0]

    def _class_without_effect(self, agent: AgentPart, key: ProjectToken) -> None:
        for text, span in self._classes():
            self.class_of_agent(key.text, text, span)

    def _node_of(self, declared: AgentPart | WorkspacePart, _: ProjectToken) -> None:
        """``node: name``, or ``host: name``."""
        declared.node = self._node_name()

    def _option(self, agent: AgentPart, key: ProjectToken) -> None:
        """Read an option of Jason, or a parameter of the project's own."""
        span = self.span_of(key)
        if key.text in agent.options:
            self.warn(f"duplicate key `{key.text}`: only the last value has an effect", span)
        meant = (
            [] if key.text in _AGENT.keys else [each for each in _AGENT.keys if is_slip_of(key.text, each)]
        )
        if meant:
            message = f"unknown key `{key.text}`, kept as a parameter of the agent"
            self.warn(message, span, did_you_mean(meant[:1]))
        agent.option_places[key.text] = span
        agent.options[key.text] = ", ".join(_unquoted(text) for text, _ in self.pieces())
        if key.text == "debug":
            self.unsupported(INSPECTORS, f"`debug` of agent `{agent.name}`", span)

    # ---- workspaces

    def _workspace(self, _: ProjectToken) -> None:
        """``workspace name { ... }``."""
        name = self.lower_name("the name of a workspace")
        workspace = WorkspacePart(name.text, self.span_of(name))
        self.part.workspaces.append(workspace)
        self._read_block(_WORKSPACE, workspace)

    def _agents(self, part: WorkspacePart, _: ProjectToken) -> None:
        part.agents += self.names()

    def _parent(self, workspace: WorkspacePart, _: ProjectToken) -> None:
        parent = self.name("the name of a workspace")
        workspace.parent, workspace.parent_span = parent.text, self.span_of(parent)

    def _inspector(self, workspace: WorkspacePart, key: ProjectToken) -> None:
        what = f"`debug` of workspace `{workspace.name}`"
        self.unsupported(INSPECTORS, what, self.span_of(key))

    def _inspector_key(self, workspace: WorkspacePart, key: ProjectToken) -> None:
        self.pieces()
        self._inspector(workspace, key)

    def _artifact(self, workspace: WorkspacePart, _: ProjectToken) -> None:
        name = self.lower_name("the name of an artifact")
        # Add it now: if the rest has an error, references to the artifact are still valid.
        part = ArtifactDeclaration(ArtifactSpec(name.text, "", span=self.span_of(name)))
        workspace.artifacts.append(part)
        self.expect(":", _ARTIFACT)
        kind = self.take("the class of the artifact", *NAME, help=_ARTIFACT)
        arguments = self._arguments() if self.token.kind == "(" else ()
        focused_by: list[AgentName] = []
        self._read_block(_OF_ARTIFACT, focused_by)
        part.focused_by = focused_by
        part.spec = replace(
            part.spec,
            type_name=text_of(kind),
            arguments=arguments,
            focused_by=tuple(agent for agent, _, _ in focused_by),
            type_span=self.span_of(kind),
        )

    def _focused_by(self, found: list[AgentName], _: ProjectToken) -> None:
        """``[namespace::]agent`` or ``*``, any number of times."""
        for token in self._items("word", "*"):
            agent, namespace = token, None
            if self.accept("::"):
                namespace = token.text
                agent = self.take("the name of an agent", "word", "*")
            found.append((agent.text, namespace, self.span_of(agent)))

    # ---- organisations and institutions

    def _organisation(self, keyword: ProjectToken) -> None:
        """``organisation name : file { ... }``, and the same of an institution: without effect, so the block is skipped."""
        is_institution = keyword.text == "institution"
        what, topic = ("institution", INSTITUTIONS) if is_institution else ("organisation", ORGANISATIONS)
        name = self.lower_name(f"the name of an {what}")
        if self.accept(":"):
            self._file_name(f"the file of the {what}")
        self.part.organisations[name.text] = topic
        self.unsupported(topic, f"the {what} `{name.text}`", self.span_of(name))
        if self.token.kind == "{":
            self.skip_block()

    readers: ClassVar = {
        "asl-path": lambda self, key: self.part.source_paths.extend(text for text, _ in self.some_names(key)),
        "org-path": _java_path,
        "java-path": lambda self, key: self.part.code_paths.extend(text for text, _ in self.some_names(key)),
        "class-path": _java_path,
        "platform": _platforms,
        "world": lambda self, _: self.world(),
        "mapping": lambda self, key: self.part.mappings.extend(self.some_names(key)),
    }
    sections = ("agent", "workspace", "node", "institution", "organisation", *readers)


_ARTIFACT: Final = "write `artifact name : Class(arguments)`"
_R = JcmReader  # the tables name its methods
_SECTIONS: Final = {
    "agent": _R._agent,
    "workspace": _R._workspace,
    "institution": _R._organisation,
    "organisation": _R._organisation,
    "organization": _R._organisation,
    "node": _R._node,
    "uses": _R._package,
}
_AGENT: Final = Block(
    "an agent",
    {
        "beliefs": lambda self, agent, _: agent.beliefs.extend(self.pieces()),
        "goals": lambda self, agent, _: agent.goals.extend(self.pieces()),
        "join": _R._join,
        "focus": _R._focus,
        "instances": _R._instances,
        "roles": _R._roles,
        "ag-class": _R._class,
        "ag-arch": _R._class_without_effect,
        "ag-bb-class": _R._class_without_effect,
        "verbose": _R._option,
        "debug": _R._option,
        "host": _R._node_of,
        "node": _R._node_of,
    },
    other=_R._option,
    is_strict=True,
)
_WORKSPACE: Final = Block(
    "a workspace",
    {
        "agents": _R._agents,
        "parent": _R._parent,
        "host": _R._node_of,
        "node": _R._node_of,
        "debug": _R._inspector_key,
    },
    {"artifact": _R._artifact, "debug": _R._inspector},
)
_OF_ARTIFACT: Final = Block("an artifact", {"focused-by": _R._focused_by})
BLOCKS: Final = {"agent": _AGENT, "workspace": _WORKSPACE, "artifact": _OF_ARTIFACT}
"""The blocks by the keyword of what has them."""


def _unquoted(text: str) -> str:
    if len(text) > 1 and text[0] == text[-1] == '"' and '"' not in text[1:-1].replace('\\"', ""):
        return text[1:-1].replace('\\"', '"')
    return text
