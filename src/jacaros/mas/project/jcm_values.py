"""Values of keys in `.jcm` project files, and blocks of keys."""

from collections.abc import Callable, Iterable
from typing import Final

from jacaros.agents.language.diagnostics import Span
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.files.texts import suggestion
from jacaros.mas.project.cursor import ProjectCursor, ProjectPanic, Token, UnclosedPanic, text_of
from jacaros.mas.project.parts import AgentName, ProjectPart, Written
from jacaros.mas.project.unsupported import NODES, Topic, Unsupported

SECTIONS: Final = ("agent", "workspace", "institution", "organisation", "organization", "node", "uses")
NAME: Final = ("word", "string")


class JcmValues:
    """Reads values at a cursor. A value ends before the next key, entry, section or closing bracket.

    Args:
        cursor: position in the file.
        part: collects the declarations.
        entries: keywords that begin an entry of the current block, besides its keys.
        keys: keys of that block.
    """

    def __init__(
        self,
        cursor: ProjectCursor,
        part: ProjectPart,
        entries: tuple[str, ...] = (),
        keys: tuple[str, ...] = (),
    ) -> None:
        self.cursor = cursor
        self.part = part
        self.entries = entries
        self.keys = keys
        self._inside = False

    def unsupported(self, topic: Topic, what: str, span: Span, detail: bool = False) -> None:
        """Record a declaration that has no effect."""
        self.part.unsupported.append(Unsupported(topic, what, span, detail))

    # where things end

    def at_section(self) -> bool:
        """Return whether a section begins here. Inside a block, a section must begin a line."""
        cursor = self.cursor
        token = cursor.token
        if token.kind != "word" or token.text not in SECTIONS or cursor.peek().kind != "word":
            return False
        return token.first or not self._inside

    def at_entry(self) -> bool:
        """Return whether a key or an entry of the block begins here."""
        cursor = self.cursor
        if cursor.at_key():
            return True
        if cursor.token.kind != "word":
            return False
        following = cursor.peek()
        if cursor.token.text in self.keys:
            # The ':' is missing.
            return cursor.token.first and following.kind in NAME and not following.first
        if cursor.token.text not in self.entries:
            return False
        if cursor.token.text == "debug":
            return following.first or following.kind not in NAME or cursor.peek(2).kind == ":"
        return following.kind == "word"

    def at_end(self) -> bool:
        """Return whether a value ends before the current token."""
        return self.cursor.token.kind in ("}", "end") or self.at_entry() or self.at_section()

    # blocks

    def block(self, entry: Callable[[], None]) -> None:
        """Read ``{ ... }``, calling *entry* for each entry. After an error, continue with the next entry."""
        around, self._inside = self._inside, True
        try:
            with self.cursor.nested():
                self._block(entry)
        finally:
            self._inside = around

    def _block(self, entry: Callable[[], None]) -> None:
        cursor = self.cursor
        opener = cursor.advance()
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail_unclosed(opener)
            if self.at_section():
                cursor.fail_unclosed(opener, "add `}` before the next section")
            start = cursor.index
            try:
                entry()
            except UnclosedPanic:
                raise
            except ProjectPanic:
                self.to_next_entry(start)
            cursor.accept(",")

    def to_next_entry(self, start: int) -> None:
        """Skip to the next entry at the beginning of a line, after an error in the one that began at *start*."""
        cursor = self.cursor
        if cursor.index == start and cursor.token.kind != "}":
            cursor.advance()
        depth = 0
        while cursor.token.kind != "end":
            if cursor.token.first and (self.at_section() or (depth <= 0 and self.at_entry())):
                return
            if cursor.token.kind == "}" and depth <= 0:
                return
            depth += (cursor.token.kind == "{") - (cursor.token.kind == "}")
            cursor.advance()

    def key(self, known: Iterable[str], what: str) -> Token:
        """Consume ``key:``.

        Args:
            known: the keys that are valid here.
            what: what has these keys, for messages.
        """
        cursor = self.cursor
        token = cursor.token
        if token.kind == "word" and not cursor.at_key():
            known = list(known)
            keys = [f"{each}:" for each in known if each not in self.entries]
            listed = f"keys of {what}: {', '.join([*self.entries, *keys])}"
            help = listed if token.text in known else suggestion(token.text, known, listed)
            cursor.fail(f"missing `:` after `{token.text}`", help=help)
        if token.kind != "word":
            cursor.fail(f"expected a key, found `{token.text}`")
        cursor.advance()
        cursor.advance()
        return token

    def unknown_key(self, key: Token, known: Iterable[str], what: str) -> None:
        """Report an unknown key and skip its value."""
        known = list(known)
        help = suggestion(key.text, known, f"keys of {what}: {', '.join(known)}")
        self.cursor.report(f"unknown key `{key.text}` in {what}", self.cursor.span_of(key), help)
        self.pieces()

    # values

    def pieces(self) -> list[Written]:
        """Return the pieces of a value, separated by commas or line ends, as written."""
        cursor = self.cursor
        found: list[Written] = []
        while not self.at_end():
            start = cursor.token

            def ends(start: Token = start) -> bool:
                token = cursor.token
                return token.kind == "," or (token.first and token is not start) or self.at_end()

            text = cursor.raw(ends)
            if text:
                found.append((text, cursor.span_of(start)))
            if not cursor.accept(",") and cursor.token is start:
                cursor.fail(f"unexpected `{start.text}`")
        return found

    def names(self) -> list[Written]:
        """Return names separated by spaces, commas or line ends."""
        cursor = self.cursor
        found: list[Written] = []
        while cursor.token.kind in (*NAME, "number", "*") and not self.at_end():
            token = cursor.advance()
            found.append((text_of(token), cursor.span_of(token)))
            cursor.accept(",")
        return found

    def classes(self) -> list[Written]:
        """Return names of classes with their arguments as written, separated by spaces, commas or line ends."""
        cursor = self.cursor
        found: list[Written] = []
        while cursor.token.kind in NAME and not self.at_end():
            token = cursor.advance()
            text = text_of(token)
            if cursor.token.kind == "(":
                text += self.bracketed()
            found.append((text, cursor.span_of(token)))
            cursor.accept(",")
        return found

    def bracketed(self) -> str:
        """Return the text from the current bracket to the matching one."""
        start = self.cursor.token.start
        self.cursor.skip_block()
        return self.cursor.file.text[start : self.cursor.before().stop]

    def file_name(self, what: str) -> Written:
        """Return the name of a file. Without quotes, it ends at a space."""
        cursor = self.cursor
        if cursor.token.kind not in NAME:
            cursor.fail(f"expected {what}, found {cursor.token}")
        first = last = cursor.advance()
        if first.kind == "string":
            return text_of(first), cursor.span_of(first)
        while cursor.token.start == last.stop and cursor.token.kind in (*NAME, ":", "number"):
            last = cursor.advance()
        return cursor.file.text[first.start : last.stop], cursor.span_of(first).to(cursor.span_of(last))

    def agent_names(self) -> list[AgentName]:
        """Return ``[namespace::]agent`` or ``*``, any number of times."""
        cursor = self.cursor
        found: list[AgentName] = []
        while cursor.token.kind in ("word", "*") and not self.at_end():
            token = cursor.advance()
            namespace = None
            if cursor.accept("::"):
                namespace = token.text
                token = cursor.advance() if cursor.token.kind == "*" else cursor.name("the name of an agent")
            found.append((token.text, namespace, cursor.span_of(token)))
            cursor.accept(",")
        return found

    def node(self, what: str) -> bool:
        """Read ``@ node`` after the name of something on another node. Return whether it is present."""
        cursor = self.cursor
        at = cursor.token
        if not cursor.accept("@"):
            return False
        name = cursor.name("the name of a node")
        self.unsupported(NODES, f"`@ {name.text}` of {what}", cursor.span_of(at).to(cursor.span_of(name)))
        return True

    def arguments(self, closer: str = ")") -> tuple[object, ...]:
        """Return the values between the current bracket and its *closer*."""
        cursor = self.cursor
        opener = cursor.advance()
        values: list[object] = []
        while not cursor.accept(closer):
            values.append(self.argument(opener))
            if cursor.token.kind != closer:
                cursor.expect(",", f"close the `{opener.kind}` in line {opener.line} with `{closer}`")
        return tuple(values)

    def argument(self, opener: Token) -> object:
        """Return one value. A string remains a string even if it looks like a number."""
        cursor = self.cursor
        token = cursor.token
        if token.kind == "[":
            with cursor.nested():
                return list(self.arguments("]"))
        if token.kind == "number":
            cursor.advance()
            return cursor.number(token)
        if token.kind not in ("word", "string", "quoted"):
            cursor.fail("expected a value", help=f"close the `{opener.kind}` in line {opener.line}")
        if token.kind == "word" and not (token.text[0].isalpha() or token.text[0] in "_$"):
            cursor.fail(
                f"expected a value, found `{token.text}`", help="write a number, or a string in quotes"
            )
        cursor.advance()
        if token.kind == "string":
            return text_of(token)
        name = token.text.strip("'") if token.kind == "quoted" else token.text
        if token.kind == "word" and name in ("true", "false"):
            return name == "true"
        if cursor.token.kind == "(" and cursor.token.start == token.stop:
            with cursor.nested():
                arguments = self.arguments()
            return Structure(name, arguments) if arguments else Atom(name)
        return Atom(name)
