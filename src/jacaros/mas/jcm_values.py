"""The values of keys in `.jcm` project files."""

from typing import Final

from jacaros.env.values import Atom, Structure
from jacaros.mas.project_cursor import ProjectCursor, Token, text_of
from jacaros.mas.project_parts import AgentName, Written

SECTIONS: Final = ("agent", "workspace", "institution", "organisation", "organization", "node", "uses")
NAME: Final = ("word", "string")


class JcmValues:
    """Reads values at the place of a cursor; a value ends before the next key, section or closing bracket."""

    def __init__(self, cursor: ProjectCursor) -> None:
        self.cursor = cursor

    def at_section(self) -> bool:
        """Whether a section, a key or the end of the block stands here."""
        token = self.cursor.token
        if token.kind in ("}", "end") or self.cursor.at_key() or token.text in SECTIONS:
            return True
        # Inside a workspace.
        return token.first and token.text in ("artifact", "debug")

    def pieces(self) -> list[Written]:
        """The pieces of a value, which are separated by commas or line ends, as written."""
        cursor = self.cursor
        found: list[Written] = []
        while not self.at_section():
            start = cursor.token

            def ends(start: Token = start) -> bool:
                token = cursor.token
                return token.kind == "," or (token.first and token is not start) or self.at_section()

            text = cursor.raw(ends)
            if text:
                found.append((text, cursor.span_of(start)))
            if not cursor.accept(",") and cursor.token is start:
                break
        return found

    def names(self) -> list[Written]:
        """Names separated by blanks, commas or line ends."""
        cursor = self.cursor
        found: list[Written] = []
        while cursor.token.kind in (*NAME, "number", "*") and not self.at_section():
            token = cursor.advance()
            found.append((text_of(token), cursor.span_of(token)))
            cursor.accept(",")
        return found

    def agent_names(self) -> list[AgentName]:
        """``[namespace::]agent`` or ``*``, several of them."""
        cursor = self.cursor
        found: list[AgentName] = []
        while cursor.token.kind in ("word", "*") and not self.at_section():
            token = cursor.advance()
            namespace = None
            if cursor.accept("::"):
                namespace, token = token.text, cursor.name("the name of an agent")
            found.append((token.text, namespace, cursor.span_of(token)))
            cursor.accept(",")
        return found

    def arguments(self, closer: str = ")") -> tuple[object, ...]:
        """The values between the bracket here and its *closer*."""
        cursor = self.cursor
        opener = cursor.advance()
        values: list[object] = []
        while not cursor.accept(closer):
            values.append(self.argument(opener))
            if cursor.token.kind != closer:
                cursor.expect(",", f"the '{opener.kind}' of line {opener.line} is closed by '{closer}'")
        return tuple(values)

    def argument(self, opener: Token) -> object:
        """One value; strings stay strings, also those that look like numbers."""
        cursor = self.cursor
        token = cursor.token
        if token.kind == "[":
            return list(self.arguments("]"))
        if token.kind == "number":
            cursor.advance()
            return int(token.text) if token.text.lstrip("-").isdigit() else float(token.text)
        if token.kind not in ("word", "string", "quoted"):
            cursor.fail(
                "a value is expected", hint=f"the '{opener.kind}' of line {opener.line} is not closed"
            )
        cursor.advance()
        if token.kind == "string":
            return text_of(token)
        if token.text in ("true", "false"):
            return token.text == "true"
        if cursor.token.kind == "(":
            return Structure(token.text, self.arguments())
        return Atom(token.text)
