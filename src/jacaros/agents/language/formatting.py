"""Format programs in the project's one style (`jacaros format`).

>>> print(format_program("robot.asl", "+!go:near<-move;!stop."), end="")
+!go : near <- move; !stop.
"""

from collections.abc import Callable, Mapping
from typing import Final

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, SourceFile, problem
from jacaros.agents.language.layout import (
    HARD,
    NOTHING,
    Break,
    Document,
    ExpressionLayout,
    Group,
    Nest,
    OwnLine,
    Row,
    pieces_of,
    render,
    row,
)
from jacaros.agents.language.lexer import Comment, tokenize
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.nodes import Declaration
from jacaros.errors import InternalError

# Lay out whole programs: clauses, plans and directives, and plan bodies with one step per line.


_CONTROL = frozenset({"if", "while", "for"})
_FORKS = ("|&|", "|||")
_BLOCK_INDENT = 3


class StepLayout(ExpressionLayout):
    """Lays out bodies and terms in braces."""

    def steps(self, begin: int, end: int, hard: bool) -> Document:
        """Lay out the steps; *hard*: each on its own line, even if all fit on one."""
        parts: list[Document | str] = []
        at = begin
        while at < end:
            if at > begin:
                blank = self.pieces[at].blank
                parts.append(Break(None if hard or blank else " ", blank))
            remarks = self.hoisted(at)
            step, at = self._step(at, end, hard)
            parts += [remarks, step]
        return row(*parts)

    def group(self, begin: int, end: int) -> Document:
        """Lay out steps in round brackets."""
        return Group(Nest(None, self.steps(begin, end, not self.on_one_line(begin, end))))

    def _step(self, begin: int, end: int, hard: bool) -> tuple[Document, int]:
        """Lay out a step with the ``;`` after it; return also the index after that."""
        parts: list[Document | str] = []
        at = begin
        while True:
            if self.pieces[at].kind in _CONTROL:
                statement, at = self._statement(at, end)
                parts.append(statement)
            else:
                stops = self.split(at, end, ";", *_FORKS)
                stop = stops[0] if stops else end
                parts.append(self.formula(at, stop))
                at = stop
            if at < end and self.pieces[at].kind in _FORKS:
                parts += [" ", self.piece(at), Break()]
                at += 1
                continue
            break
        if at < end and self.pieces[at].kind == ";":
            parts.append(self.piece(at))
            at += 1
        return Group(Nest(None, row(*parts))), at

    def _statement(self, begin: int, end: int) -> tuple[Document, int]:
        """Lay out ``if (c) { a } elif (c) { b } else { c }`` and similar statements."""
        blocks: list[tuple[int, int | None, int]] = []
        at = begin
        while True:
            condition = at + 1 if self.pieces[at].kind != "else" else None
            block = at + 1 if condition is None else self.closer[condition] + 1
            blocks.append((at, condition, block))
            behind = self.closer[block] + 1
            if behind >= end or self.pieces[behind].kind not in ("elif", "else"):
                break
            at = behind
        hard = not self.on_one_line(begin, behind)
        parts: list[Document | str] = []
        for word, condition, block in blocks:
            parts += [" ", self.piece(word)] if parts else [self.piece(word)]
            if condition is not None:
                parts += [" ", self.plain(condition, self.closer[condition] + 1)]
            parts += [" ", self.block(block, hard)]
        # One group: either all blocks of a statement are on one line, or none is.
        return Group(row(*parts)), behind

    def block(self, opener: int, hard: bool) -> Document:
        """Lay out steps in braces."""
        hard = hard or not self.on_one_line(opener, self.closer[opener] + 1)
        edge = HARD if hard else Break()
        return self._braced(opener, edge, _BLOCK_INDENT, lambda begin, end: self.steps(begin, end, hard))

    def _braced(
        self, opener: int, edge: Break, indent: int, lay_out: Callable[[int, int], Document]
    ) -> Document:
        """Lay out braces with contents between two edges, and with the comments at their end."""
        closer = self.closer[opener]
        remarks = self.pieces[closer].before
        if closer == opener + 1 and not remarks:
            return row(self.piece(opener), " ", self.piece(closer))
        inner = row(edge, lay_out(opener + 1, closer)) if closer > opener + 1 else NOTHING
        last = Row(tuple(row(HARD, OwnLine(remark.text)) for remark in remarks))
        return row(self.piece(opener), Nest(indent, row(inner, last)), edge, "}", self.line_end(closer))


_TRIGGERS = frozenset({"+", "-", "^"})
_BODY_INDENT = 2
_CONDITION_INDENT = 4


class ProgramLayout(StepLayout):
    """Lays out a program."""

    def program(self) -> Document:
        """Lay out all clauses, and the comments at the end."""
        end = len(self.pieces) - 1
        last = self.pieces[end]
        content = self.clauses(0, end)
        if not last.before:
            return row(content, HARD)
        between = Break(None, last.before[0].blank) if end else NOTHING
        return row(content, between, self.remarks(end))

    def clauses(self, begin: int, end: int) -> Document:
        """Lay out clauses, each on a new line, with at most one blank line between two."""
        parts: list[Document] = []
        at = begin
        while at < end:
            if at > begin:
                parts.append(Break(None, self.pieces[at].blank))
            remarks = self.hoisted(at)
            clause, at = self._clause(at, end)
            parts += [remarks, clause]
        return Row(tuple(parts))

    def _clause(self, begin: int, end: int) -> tuple[Document, int]:
        kind = self.pieces[begin].kind
        if kind == "{":
            return self._directive(begin), self.closer[begin] + 1
        stop = self.find(begin, end, ".")
        if kind in _TRIGGERS or kind == "@":
            return self._plan_clause(begin, stop, end)
        arrows = self.split(begin, stop, ":-")
        content = self._rule(begin, arrows[0], stop) if arrows else self.plain(begin, stop)
        return row(content, self.piece(stop)), stop + 1

    def _directive(self, opener: int) -> Document:
        closer = self.closer[opener]
        name = opener + 1
        inner: Document = self.plain(name, closer)
        if self.pieces[name].text == "begin" and closer > name + 1:
            inner = row(self.piece(name), " ", self.plain(name + 1, closer))
        return row(self.piece(opener), " ", inner, " ", self.piece(closer))

    def _rule(self, begin: int, arrow: int, end: int) -> Document:
        body = row(Break(), self.formula(arrow + 1, end))
        return Group(row(self.plain(begin, arrow), " ", self.piece(arrow), Nest(_CONDITION_INDENT, body)))

    # plans

    def _plan_clause(self, begin: int, stop: int, end: int) -> tuple[Document, int]:
        """Lay out a plan with its final dot and its sub-plans, which may replace the dot."""
        inner = next((at for at in self.split(begin, stop, "{") if self._holds_plans(at)), None)
        if inner is not None and self._is_last_of_plan(begin, inner):
            behind = self.closer[inner] + 1
            dot = self.piece(behind) if behind < end and self.pieces[behind].kind == "." else NOTHING
            plan = row(
                self.plan(begin, inner), " ", self._braced(inner, HARD, _BODY_INDENT, self.clauses), dot
            )
            return plan, behind + (dot is not NOTHING)
        plan = row(self.plan(begin, stop), self.piece(stop))
        if stop + 1 < end and self.pieces[stop + 1].kind == "{" and self._holds_plans(stop + 1):
            return row(plan, " ", self._braced(stop + 1, HARD, _BODY_INDENT, self.clauses)), self.closer[
                stop + 1
            ] + 1
        return plan, stop + 1

    def _holds_plans(self, opener: int) -> bool:
        following = self.pieces[opener + 1].kind
        return following in _TRIGGERS or following in ("@", "}")

    def _is_last_of_plan(self, begin: int, opener: int) -> bool:
        """Return whether the braces at *opener* are where the plan may end, and not where a term is expected."""
        before = self.pieces[opener - 1].kind
        if before == ")":
            return self.pieces[self.opener[opener - 1] - 1].kind not in ("if", "while", "for", "elif")
        return opener > begin and before in ("atom", "variable", "number", "string", "]", "}", "true")

    def plan(self, begin: int, end: int) -> Document:
        """Lay out a plan without its final dot: on one line if it is written so and fits."""
        hard = not self.on_one_line(begin, end)
        trigger = self._behind_label(begin)
        arrows = self.split(begin, end, "<-")
        arrow = arrows[0] if arrows else end
        head = self._head(trigger, arrow)
        parts: list[Document | str] = []
        if trigger > begin:
            parts += [self.plain(begin, trigger), HARD if hard else Break()]
        parts.append(head)
        if arrow < end:
            before = self.remarks(arrow)
            introduction = self._introduction(arrow)
            steps = Nest(None, row(introduction, self.steps(arrow + 1, end, hard)))
            parts.append(Nest(_BODY_INDENT, row(HARD if hard else Break(), before, "<- ", steps)))
        return Group(row(*parts))

    def _introduction(self, arrow: int) -> Document:
        """Lay out the comments between ``<-`` and the first step, one per line."""
        first = self.pieces[arrow + 1]
        comments = [*self.pieces[arrow].behind, *(remark.text for remark in first.before if remark.own_line)]
        first.before = [remark for remark in first.before if not remark.own_line]
        return Row(tuple(row(comment, HARD) for comment in comments))

    def _behind_label(self, begin: int) -> int:
        """Return the index of the trigger of the plan that begins at *begin*."""
        if self.pieces[begin].kind != "@":
            return begin
        at = begin + 1
        while self.pieces[at].kind in ("atom", "variable", "::", "(", "["):
            at = self.closer.get(at, at) + 1
        return at

    def _head(self, begin: int, end: int) -> Document:
        """Lay out trigger, context and goal condition."""
        signs = self.split(begin, end, ":", "<:")
        parts: list[Document | str] = [self.plain(begin, signs[0] if signs else end)]
        for sign, stop in zip(signs, [*signs[1:], end], strict=False):
            condition = row(Break(), self.piece(sign), " ", self.formula(sign + 1, stop))
            parts.append(Nest(_CONDITION_INDENT, condition))
        return Group(row(*parts))

    # terms in braces

    def braces(self, opener: int) -> Document:
        """Lay out a plan, trigger, rule or body as a term."""
        closer = self.closer[opener]
        begin = opener + 1
        if begin == closer:
            return row(self.piece(opener), " ", self.piece(closer))
        arrows = self.split(begin, closer, ":-")
        plan = self.split(begin, closer, "<-", ":", "<:") or self.pieces[begin].kind == "@"
        content: Document
        if arrows:
            content = self._rule(begin, arrows[0], closer)
        elif plan:
            content = self._inline_plan(begin, closer)
        else:
            content = self.steps(begin, closer, hard=False)
        return Group(row(self.piece(opener), " ", Nest(None, content), " ", self.piece(closer)))

    def _inline_plan(self, begin: int, end: int) -> Document:
        dots = self.split(begin, end, ".")
        stop = dots[0] if dots else end
        plan = self.plan(begin, stop)
        return plan if stop == end else row(plan, self.piece(stop))


_MOST_ROUNDS: Final = 4


def format_program(name: str, text: str, actions: Mapping[str, Declaration] | None = None) -> str:
    """Format the program *text*; tokens and comments are kept.

    Included files are not read.

    Args:
        name: the file name in diagnostics.
        text: the AgentSpeak source.
        actions: the internal actions, as for `load_program`.

    Raises:
        AslError: the program has errors.
        InternalError: formatting would change the meaning of the program.
    """
    meaning = _meaning(name, text, actions)
    try:
        result = _laid_out(text)
        for _ in range(_MOST_ROUNDS):
            # A comment that has moved to the end of another line may have to move once more.
            again = _laid_out(result)
            if again == result:
                break
            result = again
    except RecursionError:
        wrong = problem("nested-too-deeply", f"{name} is nested too deeply to be formatted", None)
        raise AslError([wrong]) from None
    if _substance(result) != _substance(text) or _meaning(name, result, actions) != meaning:
        raise InternalError(f"formatting would change the meaning of {name}")
    return result


def _laid_out(text: str) -> str:
    return render(ProgramLayout(pieces_of(SourceFile("", text))).program())


def _meaning(name: str, text: str, actions: Mapping[str, Declaration] | None) -> nodes.Program:
    return load_program(name, text, lambda path, _: (f"{path} in {name}", ""), actions=actions)[0]


def _substance(text: str) -> tuple[list[tuple[str, str]], list[str]]:
    """Return the tokens of a text, and the sorted words of its comments: formatting may join two comments."""
    comments: list[Comment] = []
    tokens = tokenize(SourceFile("", text), lambda _: None, comments)
    words = sorted(word for comment in comments for word in comment.text.split())
    return [(token.kind, token.text) for token in tokens], words
