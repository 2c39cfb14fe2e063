"""Agents in `.jcm` project files."""

from typing import Final

from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Span
from jacaros.files.texts import did_you_mean
from jacaros.mas.project.cursor import Token, text_of
from jacaros.mas.project.jcm_values import NAME, JcmValues
from jacaros.mas.project.parts import AgentPart, FocusPart, JoinPart
from jacaros.mas.project.unsupported import INSPECTORS, NODES, ROLES, class_without_effect

KEYS: Final = (
    *("beliefs", "goals", "join", "focus", "instances", "roles"),
    *("ag-class", "ag-arch", "ag-bb-class", "verbose", "debug", "host", "node"),
)


class JcmAgents(JcmValues):
    """Reads ``agent name : file { ... }``."""

    def agent(self) -> None:
        """Read one agent; the cursor is on ``agent``."""
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name("the name of an agent")
        agent = AgentPart(name.text, cursor.span_of(name))
        if cursor.accept(":"):
            agent.source, agent.source_span = self.file_name("the file of the agent")
        self.part.agents.append(agent)
        if cursor.token.kind == "{":
            self.block(lambda: self._entry(agent))
        elif not (cursor.token.first or self.at_end()):
            cursor.fail(
                f"unexpected {cursor.token} after agent `{agent.name}`",
                help="write `agent name : file.asl { ... }`, with quotes around a file name with spaces",
            )

    def _entry(self, agent: AgentPart) -> None:
        cursor = self.cursor
        key = self.key(KEYS, "an agent")
        match key.text:
            case "beliefs":
                agent.beliefs += self.pieces()
            case "goals":
                agent.goals += self.pieces()
            case "join":
                self._join(agent)
            case "focus":
                self._focus(agent)
            case "instances":
                self._instances(agent, key)
            case "ag-class":
                agent.agent_class = self._class(key, agent.agent_class)
            case "ag-arch" | "ag-bb-class":
                for text, span in self.classes():
                    found = class_without_effect(key.text, text)
                    if found is not None:
                        self.unsupported(*found, span)
            case "host" | "node":
                agent.host = " ".join(text for text, _ in self.names())
                self.unsupported(NODES, f"`{key.text}` of agent `{agent.name}`", cursor.span_of(key))
            case "roles":
                self._roles(agent)
            case _:
                self._option(agent, key)
        if cursor.token.kind not in ("}", "end", ",") and not self.at_end():
            cursor.fail(f"unexpected {cursor.token} in the value of `{key.text}`")

    def _option(self, agent: AgentPart, key: Token) -> None:
        """Read an option of Jason, or a parameter of the project's own."""
        cursor = self.cursor
        span = cursor.span_of(key)
        if key.text in agent.options:
            cursor.warn(f"duplicate key `{key.text}`: only the last value has an effect", span)
        meant = [] if key.text in KEYS else [each for each in KEYS if is_slip_of(key.text, each)]
        if meant:
            message = f"unknown key `{key.text}`, kept as a parameter of the agent"
            cursor.warn(message, span, did_you_mean(meant[:1]))
        agent.option_places[key.text] = span
        agent.options[key.text] = ", ".join(_unquoted(text) for text, _ in self.pieces())
        if key.text == "debug":
            self.unsupported(INSPECTORS, f"`debug` of agent `{agent.name}`", span)

    def _class(self, key: Token, before: str | None) -> str | None:
        cursor = self.cursor
        found = self.classes()
        if not found:
            cursor.fail(f"expected the class for `{key.text}`, found {cursor.token}")
        if len(found) > 1 or before is not None:
            cursor.report(f"duplicate key `{key.text}`: an agent has only one", found[-1][1])
        return found[0][0]

    def _instances(self, agent: AgentPart, key: Token) -> None:
        values = self.names()
        text = values[0][0] if values else ""
        if len(values) == 1 and text.isdecimal() and 0 < len(text) < 7 and int(text) > 0:
            agent.instances = int(text)
        elif values and all(text[:1].islower() for text, _ in values):
            agent.instances = [text for text, _ in values]
        else:
            self.cursor.report(
                "expected a number or names of agents as `instances`",
                values[0][1] if values else self.cursor.span_of(key),
            )

    def _join(self, agent: AgentPart) -> None:
        cursor = self.cursor
        while cursor.token.kind in NAME and not self.at_end():
            token = cursor.advance()
            name = text_of(token)
            elsewhere = self.node(f"the workspace `{name}`")
            agent.join.append(JoinPart(name, cursor.span_of(token), elsewhere))
            cursor.accept(",")

    def _focus(self, agent: AgentPart) -> None:
        cursor = self.cursor
        while cursor.token.kind == "word" and not self.at_end():
            first = token = cursor.advance()
            namespace = None
            if cursor.accept("::"):
                namespace, token = token.text, cursor.name("the name of an artifact")
            workspace, dot, artifact = token.text.rpartition(".")
            span = cursor.span_of(first).to(cursor.span_of(token))
            elsewhere = self.node(f"the artifact `{token.text}`")
            agent.focus.append(FocusPart(artifact, workspace if dot else None, namespace, span, elsewhere))
            cursor.accept(",")

    def _roles(self, agent: AgentPart) -> None:
        """Read ``role in [organisation.]group [@ node]``, any number of times."""
        cursor = self.cursor
        while cursor.token.kind == "word" and not self.at_end():
            role = cursor.advance()
            cursor.expect("in", "write `role in organisation.group`")
            group = cursor.name("the name of a group")
            span: Span = cursor.span_of(role).to(cursor.span_of(group))
            self.unsupported(ROLES, f"the role `{role.text}` in `{group.text}`", span)
            self.node(f"the group `{group.text}`")
            cursor.accept(",")


def _unquoted(text: str) -> str:
    if len(text) > 1 and text[0] == text[-1] == '"' and '"' not in text[1:-1].replace('\\"', ""):
        return text[1:-1].replace('\\"', '"')
    return text
