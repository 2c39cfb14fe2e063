"""The tokens around a position in a text that may not parse: the clause, and what the cursor is in.

>>> from jacaros.agents.language.diagnostics import SourceFile
>>> reading = reading_at(SourceFile("r.asl", "at(1). +!go : at(X) <- move(X, Spe"), Position(1, 35))
>>> reading.part, reading.prefix, [(each.name, each.argument) for each in reading.calls], reading.variables
('body', 'Spe', [('move', 1)], ['X'])
"""

from dataclasses import dataclass, field
from typing import Final, NamedTuple
from typing import Literal as OneOf

from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.agents.language.lexer import Comment, Token, tokenize
from jacaros.editors.symbols.model import Position

Part = OneOf["head", "trigger", "context", "rule", "body", "text"]
"""Where in a clause: its beginning, the event of a plan, its context, the condition of a rule, the body of a plan; or in a
comment or string, where names have no meaning.
"""
_NAMES: Final = frozenset({"atom", "variable"})
_OPENS: Final = {"(": ")", "[": "]", "{": "}"}
_BEGINS: Final = frozenset("+-!@{^")
"""What may begin a clause at the beginning of a line, so that a broken clause above does not reach it."""


class OpenCall(NamedTuple):
    """A call whose bracket is open at the cursor.

    Attributes:
        name: name of the action, belief or goal; empty for other brackets.
        argument: index of the argument that the cursor is in.
        bracket: ``(``, ``[`` or ``{``.
        words: the first names of its arguments so far, such as the receiver and performative of a message.
    """

    name: str
    argument: int
    bracket: str
    words: tuple[str, ...] = ()


@dataclass
class Reading:
    """What is around the cursor.

    Attributes:
        part: where in the clause.
        prefix: the part of a name before the cursor, with the dot of an internal action.
        replaces: its range.
        word: the whole name at the cursor, and its range; empty and None between names.
        sign: the token before the name: ``!``, ``+``, ``?``, ``@``, ``::`` and others; empty at the beginning.
        triggered: the operator of the trigger at the beginning of the clause, such as ``+!``.
        calls: the brackets that are open at the cursor, the outermost first.
        variables: names in the clause, in order.
        tokens: the clause, up to the cursor.
        arity: number of arguments of the name at the cursor.
    """

    part: Part
    prefix: str
    replaces: Span
    word: str = ""
    word_span: Span | None = None
    sign: str = ""
    triggered: str = ""
    calls: list[OpenCall] = field(default_factory=list)
    variables: list[str] = field(default_factory=list)
    tokens: list[Token] = field(default_factory=list)
    arity: int = 0


def reading_at(file: SourceFile, at: Position) -> Reading:
    """Return what is around a position, whether the text parses or not."""
    comments: list[Comment] = []
    tokens = tokens_of(file, *_around(file, at.line), comments)
    empty = Span(file, at.line, at.column, at.line, at.column)
    before = [each for each in tokens if (each.line, each.column) < at]
    last = before[-1] if before else None
    if _in_comment(comments, at) or (last is not None and _in_string(last, at)):
        return Reading("text", "", empty)
    touching = last is not None and last.line == at.line and last.end >= at.column
    named = touching and last is not None and _is_name(last)
    if not named or last is None:
        following = tokens[len(before)] if len(before) < len(tokens) else None
        if touching and last is not None and last.kind == "." and _begins_action(before):
            return _read(
                file, tokens, len(before) - 1, ".", Span(file, last.line, last.column, at.line, at.column)
            )
        reading = _read(file, tokens, len(before), "", empty)
        if following is not None and (following.line, following.column) == at and _is_name(following):
            _name(reading, file, tokens, len(before))
        return reading
    prefix = last.text[: at.column - last.column]
    reading = _read(
        file, tokens, len(before) - 1, prefix, Span(file, last.line, last.column, at.line, at.column)
    )
    _name(reading, file, tokens, len(before) - 1)
    return reading


def tokens_of(file: SourceFile, first: int, last: int, comments: list[Comment] | None = None) -> list[Token]:
    """Return the tokens of the lines from *first* to *last*, at their places in the file."""
    part = SourceFile(file.name, "\n" * (first - 1) + "\n".join(file.lines[first - 1 : last]))
    return [each for each in tokenize(part, lambda _: None, comments) if each.kind != "end"]


def _around(file: SourceFile, line: int) -> tuple[int, int]:
    """Return the first and last line of the clauses around a line: the whole text would take too long.

    In a text that may be in a long comment, the first line is that of the file.
    """
    lines = file.lines
    last = next((each for each in range(line, len(lines)) if lines[each][:1] in _BEGINS), len(lines))
    above = range(min(line, len(lines)) - 1, 0, -1)
    first = next((each for each in above if lines[each][:1] in _BEGINS), 0)
    before = "\n".join(lines[:first])
    return 1 if before.rfind("/*") > before.rfind("*/") else first + 1, last


def _is_name(token: Token) -> bool:
    return token.kind in _NAMES or token.text.isidentifier()


def _in_comment(comments: list[Comment], at: Position) -> bool:
    for comment in comments:
        lines = comment.text.count("\n")
        end = (
            comment.line + lines,
            len(comment.text.rpartition("\n")[2]) + 1 + (0 if lines else comment.column - 1),
        )
        if (comment.line, comment.column) < at and (
            at < end or (at == end and comment.text.startswith("//"))
        ):
            return True
    return False


def _in_string(last: Token, at: Position) -> bool:
    if last.kind == "error":
        return (last.text[:1] in ('"', "'") and last.line == at.line) or last.text.startswith("/*")
    return last.kind == "string" and last.line == at.line and at.column < last.end


def _begins_action(before: list[Token]) -> bool:
    """Return whether the dot before the cursor begins an internal action, and does not end a clause or follow a name."""
    if len(before) < 2:
        return False
    dot, one = before[-1], before[-2]
    adjacent = one.line == dot.line and one.end == dot.column
    return not adjacent and one.kind in (
        "<-",
        ";",
        ":",
        "&",
        "|",
        "not",
        "(",
        ",",
        "{",
        "[",
        ":-",
        "|&|",
        "|||",
        "=",
    )


def _name(reading: Reading, file: SourceFile, tokens: list[Token], index: int) -> None:
    """Note the whole name at the cursor, with the number of its arguments."""
    token = tokens[index]
    reading.word = token.text
    reading.word_span = Span(file, token.line, token.column, token.line, token.end)
    reading.arity = _arity(tokens, index + 1)


def _arity(tokens: list[Token], index: int) -> int:
    if index >= len(tokens) or tokens[index].kind != "(" or tokens[index].column != tokens[index - 1].end:
        return 0
    depth, count = 0, 1
    for token in tokens[index:]:
        depth += (token.kind in _OPENS) - (token.kind in _OPENS.values())
        count += token.kind == "," and depth == 1
        if depth == 0 or token.kind in (".", "<-"):
            break
    return count


def _read(file: SourceFile, tokens: list[Token], index: int, prefix: str, replaces: Span) -> Reading:
    """Read the clause before the token at *index*."""
    start = _start(tokens, index)
    clause = tokens[start:index]
    part: Part = "head"
    opened: list[OpenCall] = []
    for number, token in enumerate(clause):
        kind = token.kind
        if kind in _OPENS:
            called = clause[number - 1] if number else None
            joined = (
                called is not None
                and called.kind == "atom"
                and (called.line, called.end) == (token.line, token.column)
            )
            opened.append(OpenCall(called.text if joined and called is not None else "", 0, kind))
        elif kind in _OPENS.values() and opened:
            opened.pop()
        elif kind == "," and opened:
            opened[-1] = opened[-1]._replace(argument=opened[-1].argument + 1)
        elif not opened:
            part = _part_after(token, part, number)
        if opened and kind in _NAMES and clause[number - 1].kind in ("(", ","):
            opened[-1] = opened[-1]._replace(words=(*opened[-1].words, token.text))
    end = _end(tokens, index)
    names = dict.fromkeys(
        each.text
        for at, each in enumerate(tokens[start:end])
        if each.kind == "variable" and (start + at != index or not prefix)
    )
    first = [each.text for each in clause[_label_end(clause) :][:2]]
    triggered = "".join(each for each in first if each in ("+", "-", "!", "?", "^"))
    return Reading(
        part,
        prefix,
        replaces,
        sign=clause[-1].kind if clause else "",
        triggered=triggered,
        calls=opened,
        variables=[each for each in names if each != "_"],
        tokens=clause,
    )


def _part_after(token: Token, part: Part, number: int) -> Part:
    match token.kind:
        case "<-":
            return "body"
        case ":-":
            return "rule"
        case ":" if part in ("head", "trigger"):
            return "context"
        case "+" | "-" | "^" | "@" if number == 0 or part == "trigger":
            return "trigger"
    return part


def _label_end(clause: list[Token]) -> int:
    """Return the index after the label of a plan."""
    if len(clause) < 2 or clause[0].kind != "@":
        return 0
    if len(clause) > 2 and clause[2].kind == "[":
        closes = (number for number, each in enumerate(clause) if each.kind == "]")
        return next(closes, len(clause) - 1) + 1
    return 2


def _start(tokens: list[Token], index: int) -> int:
    """Return the index of the first token of the clause around *index*."""
    for number in range(index - 1, -1, -1):
        token = tokens[number]
        if token.kind == ".":
            return number + 1
        if token.first and token.column == 1 and token.kind in _BEGINS:
            return number
        if token.kind == "}" and _is_directive(tokens, number):
            return number + 1
    return 0


def _is_directive(tokens: list[Token], close: int) -> bool:
    """Return whether a closing brace ends a directive, such as ``{ include("a.asl") }``."""
    for number in range(close, -1, -1):
        if tokens[number].kind == "{":
            return tokens[number].first and (number == 0 or tokens[number - 1].kind in (".", "}"))
    return False


def _end(tokens: list[Token], index: int) -> int:
    for number in range(index, len(tokens)):
        token = tokens[number]
        if token.kind == "." or (
            token.first and token.column == 1 and token.kind in _BEGINS and number > index
        ):
            return number
    return len(tokens)
