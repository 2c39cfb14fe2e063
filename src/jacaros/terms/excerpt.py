"""Logs show an `excerpt` of a long term.

>>> from jacaros.terms.text import text
>>> text(excerpt(make_list(map(float, range(360))), 4))
'[0,1,2|...]'
"""

from jacaros.terms.values import (
    NIL,
    PLAN,
    Annotated,
    List,
    Term,
    Var,
    deref,
    is_list,
    make_list,
    parts_of_list,
)

MOST_PARTS = 150
"""Maximum number of names, numbers and brackets in an excerpt: more than fit into a line."""
REST = Var("...")
"""Stands for the rest that was left out."""


def excerpt(term: Term, parts: int = MOST_PARTS) -> Term:
    """Return the term, with dots in place of what follows its first *parts* parts.

    Variables are replaced by their values; arithmetic is unchanged. A term that contains itself has an excerpt, too.
    Plans and their bodies stay whole.

    The text of a small term with shared parts, as in ``f(T,T)`` with such a ``T``, can exceed any memory, and a list of
    all ranges of a laser is longer than a reader needs.
    """
    return _Excerpt(parts).of(term)


class _Excerpt:
    """Takes parts until there are enough; each level takes one, which limits the depth."""

    def __init__(self, parts: int) -> None:
        self._left = parts

    def of(self, term: Term) -> Term:
        term = deref(term)
        kind = term.__class__
        if kind is not tuple and kind is not Annotated and kind is not List:
            self._left -= 1
            return term
        if self._left <= 0:
            return REST
        self._left -= 1
        if kind is Annotated:
            annotations = tuple(self.of(each) for each in term.annotations)
            return Annotated(self.of(term.term), annotations, term.tail)
        if is_list(term):
            return self._list(term)
        if term[0].kind == PLAN:
            return term
        return (term[0], *(self.of(argument) for argument in term[1:]))

    def _list(self, cell: Term) -> Term:
        elements: list[Term] = []
        while is_list(cell) and cell is not NIL:
            if self._left <= 0:
                return make_list(elements, REST)
            first, cell = parts_of_list(cell)
            elements.append(self.of(first))
            cell = deref(cell)
        return make_list(elements, self.of(cell))
