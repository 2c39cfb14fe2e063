"""Plan bodies: one step a line, blocks indented."""

from jacaros.asl.layout.document import HARD, Break, Document, Group, Nest, OwnLine, Row, row
from jacaros.asl.layout.expressions import ExpressionLayout

_CONTROL = frozenset({"if", "while", "for"})
_FORKS = ("|&|", "|||")
_BLOCK_INDENT = 3


class StepLayout(ExpressionLayout):
    """Lays out bodies and what stands in braces."""

    def steps(self, begin: int, end: int, hard: bool) -> Document:
        """The steps; *hard*: each on a line of its own, also where all would fit on one."""
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
        """Steps in round brackets."""
        return Group(Nest(None, self.steps(begin, end, not self.on_one_line(begin, end))))

    def _step(self, begin: int, end: int, hard: bool) -> tuple[Document, int]:
        """A step with the ``;`` behind it, and the index behind that."""
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
        """``if (c) { a } elif (c) { b } else { c }`` and the like."""
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
        # One group: either all blocks of a statement stand on one line, or none does.
        return Group(row(*parts)), behind

    def block(self, opener: int, hard: bool) -> Document:
        """Steps in braces."""
        closer = self.closer[opener]
        closing = self.pieces[closer]
        if closer == opener + 1 and not closing.before:
            return row(self.piece(opener), " ", self.piece(closer))
        hard = hard or not self.on_one_line(opener, closer + 1)
        edge = HARD if hard else Break()
        last = Row(tuple(row(HARD, OwnLine(remark.text)) for remark in closing.before))
        inner = self.steps(opener + 1, closer, hard) if closer > opener + 1 else Row(())
        first = edge if closer > opener + 1 else Row(())
        content = Nest(_BLOCK_INDENT, row(first, inner, last))
        return row(self.piece(opener), content, edge, "}", self.line_end(closer))
