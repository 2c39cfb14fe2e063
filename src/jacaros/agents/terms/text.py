"""Terms as AgentSpeak text, as Jason prints them.

>>> from jacaros.agents.terms.values import structure, atom, make_list
>>> text(structure("seen", String("a cup"), make_list([1.0, 0.5])))
'seen("a cup",[1,0.5])'
>>> display(String("a cup"))
'a cup'
"""

import math
from collections.abc import Iterable
from typing import Any, cast

from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.plans import (
    BODIES,
    BODY_END,
    BODY_SEQUENCE,
    BODY_TERM,
    PLAN_TRIGGER,
    body_steps,
    plan_text_parts,
    step_parts,
    trigger_parts,
)
from jacaros.agents.terms.plans import PLAN as PLAN_TERM
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.values import (
    ARITHMETIC,
    CONS,
    LOGIC,
    NEGATED,
    NIL,
    NUMBERS,
    PLAIN,
    PLAN,
    RELATION,
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Term,
    Var,
    deref,
    is_list,
    make_list,
    parted,
    parts_of_list,
)

# Logs show an `excerpt` of a long term.


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


_LEAST, _GREATEST, _LARGEST = -(2.0**63), 2.0**63, 2**63 - 1
"""Limits of Java's ``long``; `_GREATEST` is one more than the largest value."""


def number_text(value: float) -> str:
    """Format a number: integral values without a fraction, others in the shortest form of Java's doubles."""
    if value.__class__ is int:
        return str(value)
    if _LEAST <= value <= _GREATEST:
        whole = int(value)
        if whole == value:
            return str(whole) if whole <= _LARGEST else str(_LARGEST)
    return double_text(value)


def double_text(value: float) -> str:
    """Format a number as Java's ``Double.toString``: always with a fraction or an exponent."""
    if value != value:
        return "NaN"
    if math.isinf(value):
        return "Infinity" if value > 0 else "-Infinity"
    magnitude = abs(value)
    if 1e-3 <= magnitude < 1e7 or magnitude == 0.0:
        return repr(value)
    places = next(n for n in range(1, 17) if n == 16 or float(f"{value:.{n}e}") == value)
    mantissa, _, exponent = f"{value:.{places}e}".partition("e")
    return f"{mantissa}E{int(exponent)}"


def quoted(text: str) -> str:
    """Return a string in double quotes, as written in a program; `text` does not escape its characters."""
    return '"' + text.replace("\n", "\\n").replace('"', '\\"') + '"'


def unquoted(written: str) -> str:
    r"""Return the value of a quoted string: ``\n`` and ``\"`` are converted, other backslashes are kept."""
    inner = written[1:-1]
    return inner.replace("\\n", "\n").replace('\\"', '"') if "\\" in inner else inner


def text(term: Term) -> str:
    """Return the text of a term with all bindings applied, strings in quotes."""
    if term.__class__ in NUMBERS:
        return number_text(term)
    term = resolve(term)
    return (term.__class__ is tuple and _flat(term)) or _write(term)


def display(term: Term) -> str:
    """Return the text of a term as ``.print`` shows it: a string without quotes, an unbound variable marked."""
    term = resolve(term)
    if term.__class__ is String:
        return str(term)
    if _is_unknown(term):
        return f"{_write(term)}<no-value>"
    return _write(term)


def _is_unknown(term: Term) -> bool:
    """Return whether a term is an unbound variable, possibly negated or with annotations."""
    if term.__class__ is Annotated:
        term = term.term
    if term.__class__ is tuple and term[0] is NEGATED:
        term = term[1]
    return term.__class__ is Var


_Pieces = list[Any]
"""What a term is written as: texts (plain `str`) and further terms."""


def _write(term: Term) -> str:
    """Write a term with a list of pending parts, as terms may be nested as deeply as memory allows."""
    written: list[str] = []
    todo: _Pieces = [term]
    inside: set[int] = set()
    while todo:
        piece = todo.pop()
        kind = piece.__class__
        if kind is str:
            written.append(piece)
        elif kind in NUMBERS:
            written.append(number_text(piece))
        elif kind is Functor:
            written.append(_name(piece) if piece is not BODY_END else "{ }")
        elif kind is String:
            written.append(f'"{piece}"')
        elif kind is tuple:
            flat = _flat(piece)
            if flat:
                written.append(flat)
            else:
                todo.extend(reversed(_structure(piece)))
        elif kind is List:
            todo.extend(reversed(_list(piece)))
        elif kind is Annotated:
            todo.extend(reversed(_annotated(piece)))
        elif kind is Var:
            bound = deref(piece)
            todo.append(str(bound.name) if bound.__class__ is Var else bound)
        elif kind is _End:
            inside.remove(piece.identity)
        elif id(piece) in inside:
            written.append("...")
        else:
            inside.add(id(piece))
            todo.append(_End(id(piece)))
            todo.extend(reversed(_object(piece)))
    return "".join(written)


def _separated(terms: Iterable[Term]) -> _Pieces:
    pieces: _Pieces = []
    for term in terms:
        pieces += (",", term)
    return pieces[1:]


def _name(symbol: Functor) -> str:
    prefix = f"{symbol.namespace}::" if symbol.namespace else ""
    return f"{prefix}~{symbol.name}" if symbol.negated else prefix + symbol.name


def _annotated(term: Annotated) -> _Pieces:
    tail = [] if term.tail is None else ["|", term.tail]
    return [term.term, "[", *_separated(term.annotations), *tail, "]"]


def _flat(term: tuple[Term, ...]) -> str:
    """Write a structure whose arguments are numbers, strings and atoms, as most are; return an empty string for others."""
    symbol = term[0]
    if symbol.kind != PLAIN or symbol is CONS:
        return ""
    arguments = []
    for argument in term[1:]:
        kind = argument.__class__
        if kind in NUMBERS:
            arguments.append(number_text(argument))
        elif kind is String:
            arguments.append(f'"{argument}"')
        elif kind is Functor and argument is not BODY_END:
            arguments.append(_name(argument))
        else:
            return ""
    return f"{_name(symbol)}({','.join(arguments)})"


def _structure(term: tuple[Term, ...]) -> _Pieces:
    symbol = term[0]
    if symbol is CONS:
        return _list(term)
    if symbol.kind in (ARITHMETIC, RELATION, LOGIC):
        return _operator(term)
    if symbol is NEGATED:
        return ["~", term[1]]
    if symbol.kind == PLAN:
        return _plan_piece(term)
    return [_name(symbol), "(", *_separated(term[1:]), ")"]


def _list(term: Term) -> _Pieces:
    items, end = parted(term)
    tail = [] if end is NIL else ["|", end]
    return ["[", *_separated(items), *tail, "]"]


def _operator(term: tuple[Term, ...]) -> _Pieces:
    symbol = term[0]
    if symbol.arity == 1:
        return (
            [f"{symbol.name} (", term[1], ")"] if symbol.kind == LOGIC else [f"({symbol.name}", term[1], ")"]
        )
    return ["(", term[1], BINARY[symbol.name].between, term[2], ")"]


def _plan_piece(term: tuple[Term, ...]) -> _Pieces:
    name = cast("Functor", term[0]).name
    if name == "plan":
        return ["{ ", *_plan(term), " }"]
    if name in ("trigger", "plan_trigger"):
        operator, literal = trigger_parts(term)
        return [operator, literal] if term[0] is PLAN_TRIGGER else ["{ " + operator, literal, " }"]
    if name == "rule":
        return ["{ ", term[1], " :- ", term[2], " }"]
    if term[0] is BODY_TERM:
        return ["{ ", *_body(term), " }"]
    return _body(term) if term[0] in BODIES else _step(term)


def _body(body: Term) -> _Pieces:
    return [piece for step in body_steps(body) for piece in ("; ", *_step(step))][1:]


def _plan(term: tuple[Term, ...]) -> _Pieces:
    label, operator, literal, context, body = plan_text_parts(term)
    pieces: _Pieces = []
    bare_label = deref(label)
    if bare_label.__class__ is not Functor or bare_label.name != "nolabel":
        pieces += ("@", label, " ")
    pieces += (operator, literal)
    if not (context.__class__ is Functor and context.name == "true"):
        pieces += (" : ", context)
    if body is not BODY_END:
        pieces += (" <- ", *_body(body))
    return pieces


def plan_text(plan: Term) -> str:
    """Return a plan as written in a program, without braces."""
    return (
        "".join(_write(piece) if piece.__class__ is not str else piece for piece in _plan(resolve(plan)))
        + "."
    )


_STATEMENTS = {
    "if": (".if_then_else",),
    "while": (".loop",),
    "for": (".foreach",),
    "|&|": (".fork", "and"),
    "|||": (".fork", "or"),
}
"""The internal actions that control statements are in Jason, and in what it prints."""
_PLAN_CHANGES = {
    "+": (".add_plan", "self", "begin"),
    "+<": (".add_plan", "self", "begin"),
    "+>": (".add_plan", "self", "end"),
    "-": (".remove_plan",),
}


def _step(step: Term) -> _Pieces:
    operator, operands = step_parts(step)
    if operator in _STATEMENTS:
        name, *first = _STATEMENTS[operator]
        written = [[word] for word in first] + [_body(o) if _is_part(o) else [o] for o in operands]
        return [f"{name}(", *[piece for part in written for piece in (",", *part)][1:], ")"]
    if operator in _PLAN_CHANGES and _is_plan(operands[0]):
        name, *more = _PLAN_CHANGES[operator]
        return [f"{name}(", operands[0], *[f",{word}" for word in more], ")"]
    return ["+" if operator == "+<" else operator, operands[0]]


def _is_part(term: Term) -> bool:
    """Whether an operand is the body of a control statement."""
    return term is BODY_END or (term.__class__ is tuple and term[0] is BODY_SEQUENCE)


def _is_plan(term: Term) -> bool:
    return term.__class__ is tuple and term[0] is PLAN_TERM


class _End:
    """The end of a collection that is being written; one that contains itself is not written again inside."""

    __slots__ = ("identity",)

    def __init__(self, identity: int) -> None:
        self.identity = identity


def _object(term: Term) -> _Pieces:
    if isinstance(term, SetValue):
        return ["{", *_separated(term), "}"]
    if isinstance(term, MapValue):
        pairs = [piece for key in term for piece in (",", key, "->", term.items[key])]
        return ["{", *pairs[1:], "}"]
    if isinstance(term, QueueValue):
        return ["[", *_separated(term), "]"]
    return [f"cobj_{term.number}" if isinstance(term, Reference) else str(term)]
