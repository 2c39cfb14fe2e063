"""What the two languages of project files have in common: a head, sections in braces, and recovery after errors."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, ClassVar

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.mas.project.cursor import (
    ProjectCursor,
    ProjectPanic,
    ProjectToken,
    UnclosedPanic,
    text_of,
)
from jacaros.runtime.mas.project.declarations import Ignored, ProjectPart, Unsupported, class_without_effect

NAME = ("word", "string")


class ProjectReader(ProjectCursor):
    """Reads one project file.

    Attributes:
        keyword: the word with which a file begins.
        kind: the ending of its name.
        sections: the names of sections for messages.
        readers: by key, reads the value of ``key:``, given the token of the key.
        part: the declarations so far.
    """

    keyword: ClassVar[str]
    kind: ClassVar[str]
    sections: ClassVar[Sequence[str]]
    readers: ClassVar[Mapping[str, Callable[[Any, ProjectToken], object]]]

    def __init__(self, file: SourceFile, diagnostics: list[Diagnostic]) -> None:
        super().__init__(file, diagnostics)
        self.part = ProjectPart()

    def read(self) -> ProjectPart:
        """Return the declarations of the file."""
        with suppress(ProjectPanic):
            self._project()
        return self.part

    def _project(self) -> None:
        begin = f"begin the file with `{self.keyword} name {{`"
        self.expect(self.keyword, begin)
        self.head()
        opener = self.expect("{", begin)
        while not self.accept("}"):
            if self.token.kind == "end":
                self.fail("`{` is not closed", self.span_of(opener), "end the file with `}`")
            start = self.index
            try:
                self._section()
            except ProjectPanic as panic:
                if not isinstance(panic, UnclosedPanic):
                    self._to_next_section(start)
                if self.token.kind == "end":
                    return  # the error may have consumed the closing bracket of the file
        if self.token.kind != "end":
            self.report(
                f"unexpected {self.token} after the end of the system",
                help="check for an extra `}` before it",
            )

    def head(self) -> None:
        """Read what is between the keyword and the first bracket."""
        raise NotImplementedError

    def _section(self) -> None:
        if not self.at_key_of_project():
            self.other_section()
            return
        key = self.advance()
        self.advance()
        self.readers[key.text](self, key)

    def other_section(self) -> None:
        """Read a section that is not ``key:``, or fail."""
        token = self.token
        help = suggestion(token.text, self.sections, f"expected one of {', '.join(self.sections)}")
        self.fail(f"unknown section {token} in a {self.kind} file", help=help)

    def at_key_of_project(self) -> bool:
        """Return whether ``key:`` of the project comes next."""
        return self.token.text in self.readers and self.at_key()

    def at_next_section(self) -> bool:
        """Return whether a section certainly begins here."""
        raise NotImplementedError

    def _to_next_section(self, start: int) -> None:
        """Skip to the next section, after an error in the one that began at *start*."""
        if self.index == start:
            self.advance()
        while self.token.kind != "end" and not self.at_next_section():
            self.advance()

    def unsupported(self, topic: Ignored, what: str, span: Span) -> None:
        """Record a declaration that has no effect."""
        self.part.unsupported.append(Unsupported(topic, what, span))

    def class_of_agent(self, key: str, name: str, span: Span) -> None:
        """Record a class of an agent that has no effect."""
        found = class_without_effect(key, name)
        if found is not None:
            self.unsupported(*found, span)

    def parameters(self) -> str:
        """Return the text from the current bracket to the matching one; empty without one."""
        if self.token.kind != "(":
            return ""
        start = self.token.start
        self.skip_block()
        return self.file.text[start : self.before().stop]

    def world(self, kinds: Sequence[str] = NAME) -> None:
        """Read the name of a world."""
        name = self.take("the name of a world file", *kinds)
        self.part.world, self.part.world_span = text_of(name), self.span_of(name)
