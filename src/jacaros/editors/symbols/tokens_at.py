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
_BEFORE_ACTIONS: Final = frozenset(
    {"<-", ";", ":", "&", "|", "not", "(", ",", "{", "[", ":-", "|&|", "|||", "="}
)
"""What may be before an internal action."""


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
    index = sum((each.line, each.column) < at for each in tokens)
    last = tokens[index - 1] if index else None
    if _in_comment(comments, at) or (last is not None and _in_string(last, at)):
        return Reading("text", "", Span(file, at.line, at.column, at.line, at.column))
    if last is not None and last.line == at.line and last.end >= at.column:
        index -= _is_name(last) or _begins_action(tokens[:index])  # the name that the cursor is in
    here = tokens[index] if index < len(tokens) and (tokens[index].line, tokens[index].column) <= at else None
    start = at.column if here is None else here.column
    prefix = "" if here is None else here.text[: at.column - start]
    reading = _read(tokens, index, prefix, Span(file, at.line, start, at.line, at.column))
    if here is not None and _is_name(here):
        reading.word, reading.arity = here.text, _arity(tokens, index + 1)
        reading.word_span = Span(file, here.line, here.column, here.line, here.end)
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
    for text, line, column, _ in comments:
        *above, last = text.split("\n")
        end = (line + len(above), len(last) + (1 if above else column))
        if (line, column) < at and (at < end or (at == end and text.startswith("//"))):
            return True
    return False


def _in_string(last: Token, at: Position) -> bool:
    if last.kind == "error":
        return (last.text[:1] in ('"', "'") and last.line == at.line) or last.text.startswith("/*")
    return last.kind == "string" and last.line == at.line and at.column < last.end


def _begins_action(before: list[Token]) -> bool:
    """Return whether the dot before the cursor begins an internal action, and does not end a clause or follow a name."""
    if len(before) < 2 or before[-1].kind != ".":
        return False
    dot, one = before[-1], before[-2]
    return (one.line, one.end) != (dot.line, dot.column) and one.kind in _BEFORE_ACTIONS


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


def _read(tokens: list[Token], index: int, prefix: str, replaces: Span) -> Reading:
    """Read the clause before the token at *index*."""
    start, end = _start(tokens, index), _end(tokens, index)
    clause = tokens[start:index]
    part: Part = "head"
    opened: list[OpenCall] = []
    for number, token in enumerate(clause):
        before = clause[number - 1] if number else None
        if token.kind in _OPENS:
            opened.append(OpenCall(_called(before, token), 0, token.kind))
        elif not opened:
            part = _part_after(token, part, number)
        elif token.kind in _OPENS.values():
            opened.pop()
        elif token.kind == ",":
            opened[-1] = opened[-1]._replace(argument=opened[-1].argument + 1)
        elif token.kind in _NAMES and before is not None and before.kind in ("(", ","):
            opened[-1] = opened[-1]._replace(words=(*opened[-1].words, token.text))
    rest = tokens[index + bool(prefix) : end]
    names = dict.fromkeys(each.text for each in (*clause, *rest) if each.kind == "variable")
    names.pop("_", None)
    first = [each.text for each in clause[_label_end(clause) :][:2]]
    triggered = "".join(each for each in first if each in ("+", "-", "!", "?", "^"))
    sign = clause[-1].kind if clause else ""
    return Reading(part, prefix, replaces, "", None, sign, triggered, opened, list(names), clause)


def _called(before: Token | None, opener: Token) -> str:
    """Return the name that is written right before a bracket."""
    joined = before is not None and (before.line, before.end) == (opener.line, opener.column)
    return before.text if joined and before is not None and before.kind == "atom" else ""


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
    return next((number for number in range(index, len(tokens)) if tokens[number].kind == "."), len(tokens))
