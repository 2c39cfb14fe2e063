"""The tokens of a file with the comments that belong to them."""

from dataclasses import dataclass, field

from jacaros.asl.lexer import Comment, Token, tokenize
from jacaros.asl.source import SourceFile


@dataclass(slots=True)
class Remark:
    """A comment before a token; ``blank``: there is a blank line before it."""

    text: str
    own_line: bool
    blank: bool


@dataclass(slots=True)
class Piece:
    """A token with the comments before it and those behind it at the end of its line.

    ``blank`` tells whether there is a blank line before it, or before its first comment.
    """

    token: Token
    blank: bool
    before: list[Remark] = field(default_factory=list)
    behind: list[str] = field(default_factory=list)
    blank_behind_remarks: bool = False

    @property
    def kind(self) -> str:
        """The kind of the token."""
        return self.token.kind

    @property
    def text(self) -> str:
        """The text of the token."""
        return self.token.text


def pieces_of(file: SourceFile) -> list[Piece]:
    """The pieces of a file; the last one is of kind ``end`` and holds the comments at the end."""
    comments: list[Comment] = []
    tokens = tokenize(file, lambda _: None, comments)[:-1]
    pieces: list[Piece] = []
    at = 0
    last_line = 0
    for index, token in enumerate(tokens):
        piece = Piece(token, False)
        following = None if token.kind == "end" else token.line
        while at < len(comments) and comments[at].next_token <= index:
            comment = comments[at]
            at += 1
            end_line = comment.line + comment.text.count("\n")
            blank = comment.line > last_line + 1 and last_line > 0
            if pieces and not piece.before and comment.line == last_line and following != end_line:
                pieces[-1].behind.append(_clean(comment.text))
            else:
                own = following != end_line or "\n" in comment.text
                piece.before.append(Remark(_clean(comment.text), own, blank))
            last_line = end_line
        blank = token.line > last_line + 1 and last_line > 0 and token.kind != "end"
        piece.blank = piece.before[0].blank if piece.before else blank
        piece.blank_behind_remarks = bool(piece.before) and blank
        last_line = max(last_line, token.line)
        pieces.append(piece)
    return pieces


def _clean(comment: str) -> str:
    return "\n".join(line.rstrip() for line in comment.split("\n"))
