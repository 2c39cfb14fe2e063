"""Values as a tree of variables, of which the editor opens the parts that the user looks at."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from jacaros.agents.terms.values import Functor, List, String, Term, Var, annotations_of, bare, deref
from jacaros.look.records.words import cut, shown

Variable = dict[str, Any]
Make = Callable[[], Iterable[Variable]]
MOST = 1_000
"""Maximum number of parts of one value."""


class Variables:
    """Variables by the references that the editor has; valid until the run continues."""

    def __init__(self) -> None:
        self._made: list[Make] = []

    def forget(self) -> None:
        """Drop all references."""
        self._made.clear()

    def group(self, name: str, value: str, make: Make, **more: Any) -> Variable:
        """Return a variable whose parts *make* returns once they are looked at."""
        self._made.append(make)
        return {"name": name, "value": value, "variablesReference": len(self._made), **more}

    def parts(self, reference: int) -> list[Variable]:
        """Return the parts of a variable; none for an unknown reference."""
        if not 0 < reference <= len(self._made):
            return []
        return list(self._made[reference - 1]())[:MOST]

    def term(self, name: str, term: Term) -> Variable:
        """Return a term as a variable."""
        value = deref(term)
        parts, annotations = _parts(bare(value)), annotations_of(value)
        more = {"type": _kind(value)}
        if not parts and not annotations:
            return plain(name, shown(value), **more)

        def make() -> Iterable[Variable]:
            yield from self._numbered(parts)
            if annotations:
                yield self.group("annotations", _listed(annotations), lambda: self._numbered(annotations))

        return self.group(name, shown(bare(value)), make, **more)

    def _numbered(self, terms: Sequence[Term]) -> Iterable[Variable]:
        return (self.term(str(number), each) for number, each in enumerate(terms, 1))

    def terms(self, terms: Mapping[str, Term]) -> list[Variable]:
        """Return the values of variables of a plan by name."""
        return [{**self.term(name, value), "evaluateName": name} for name, value in terms.items()]


def plain(name: str, value: str, **more: Any) -> Variable:
    """Return a variable without parts."""
    return {"name": name, "value": value, "variablesReference": 0, **more}


def _listed(terms: Iterable[Term]) -> str:
    return cut(", ".join(map(shown, terms)))


def _parts(term: Term) -> Sequence[Term]:
    if isinstance(term, List):
        return term.elements()
    return term[1:] if isinstance(term, tuple) else ()


def _kind(term: Term) -> str:
    inner = bare(term)
    kinds: Mapping[type, str] = {
        float: "number",
        String: "string",
        Functor: "atom",
        tuple: "structure",
        List: "list",
        Var: "variable",
    }
    return kinds.get(type(inner), type(inner).__name__)
