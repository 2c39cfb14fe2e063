"""What the two languages of project files have in common: a head, sections in braces, and recovery after errors."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, ClassVar

from jacaros.agents.language.diagnostics import Span
from jacaros.files.texts import suggestion
from jacaros.mas.project.cursor import ProjectCursor, ProjectPanic, Token, UnclosedPanic, text_of
from jacaros.mas.project.declarations import ProjectPart, Topic, Unsupported, class_without_effect

NAME = ("word", "string")


class ProjectReader:
    """Reads one project file. Errors are collected in the cursor.

    Attributes:
        keyword: the word with which a file begins.
        kind: the ending of its name.
        sections: the names of sections for messages.
        readers: by key, reads the value of ``key:``, given the token of the key.
        cursor: position in the file.
        part: the declarations so far.
    """

    keyword: ClassVar[str]
    kind: ClassVar[str]
    sections: ClassVar[Sequence[str]]
    readers: ClassVar[Mapping[str, Callable[[Any, Token], object]]]

    def __init__(self, cursor: ProjectCursor) -> None:
        self.cursor = cursor
        self.part = ProjectPart()

    def read(self) -> ProjectPart:
        """Return the declarations of the file."""
        with suppress(ProjectPanic):
            self._project()
        return self.part

    def _project(self) -> None:
        cursor = self.cursor
        begin = f"begin the file with `{self.keyword} name {{`"
        cursor.expect(self.keyword, begin)
        self.head()
        opener = cursor.expect("{", begin)
        while not cursor.accept("}"):
            if cursor.token.kind == "end":
                cursor.fail("`{` is not closed", cursor.span_of(opener), "end the file with `}`")
            start = cursor.index
            try:
                self._section()
            except ProjectPanic as panic:
                if not isinstance(panic, UnclosedPanic):
                    self._to_next_section(start)
                if cursor.token.kind == "end":
                    return  # the error may have consumed the closing bracket of the file
        if cursor.token.kind != "end":
            cursor.report(
                f"unexpected {cursor.token} after the end of the system",
                help="check for an extra `}` before it",
            )

    def head(self) -> None:
        """Read what is between the keyword and the first bracket."""
        raise NotImplementedError

    def _section(self) -> None:
        cursor = self.cursor
        if not self.at_key_of_project():
            self.other_section()
            return
        key = cursor.advance()
        cursor.advance()
        self.readers[key.text](self, key)

    def other_section(self) -> None:
        """Read a section that is not ``key:``, or fail."""
        token = self.cursor.token
        help = suggestion(token.text, self.sections, f"expected one of {', '.join(self.sections)}")
        self.cursor.fail(f"unknown section {token} in a {self.kind} file", help=help)

    def at_key_of_project(self) -> bool:
        """Return whether ``key:`` of the project comes next."""
        return self.cursor.token.text in self.readers and self.cursor.at_key()

    def at_next_section(self) -> bool:
        """Return whether a section certainly begins here."""
        raise NotImplementedError

    def _to_next_section(self, start: int) -> None:
        """Skip to the next section, after an error in the one that began at *start*."""
        cursor = self.cursor
        if cursor.index == start:
            cursor.advance()
        while cursor.token.kind != "end" and not self.at_next_section():
            cursor.advance()

    def unsupported(self, topic: Topic, what: str, span: Span, detail: bool = False) -> None:
        """Record a declaration that has no effect."""
        self.part.unsupported.append(Unsupported(topic, what, span, detail))

    def class_of_agent(self, key: str, name: str, span: Span) -> None:
        """Record a class of an agent that has no effect."""
        found = class_without_effect(key, name)
        if found is not None:
            self.unsupported(*found, span)

    def parameters(self) -> str:
        """Return the text from the current bracket to the matching one; empty without one."""
        cursor = self.cursor
        if cursor.token.kind != "(":
            return ""
        start = cursor.token.start
        cursor.skip_block()
        return cursor.file.text[start : cursor.before().stop]

    def world(self, kinds: Sequence[str] = NAME) -> None:
        """Read the name of a world."""
        name = self.cursor.take("the name of a world file", *kinds)
        self.part.world, self.part.world_span = text_of(name), self.cursor.span_of(name)
