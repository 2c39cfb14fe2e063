"""What Python code gives to agents: text of the language, or data, which is never parsed.

================================================  ==========================================================
given                                             meaning
================================================  ==========================================================
``"check_in(ann)"``                               text of the language
``"check_in(Who)", Who="Ann, O'Hara"``            text, with values for its variables
``"check_in", "Ann, O'Hara"``                     a name and its arguments
``("check_in", "Ann, O'Hara")``                   the same as one object; as content of a message, a list
`Structure`, dataclass, `Literal`, `LiteralText`  itself; see `jacaros.artifacts.env.values.plain`
================================================  ==========================================================
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from jacaros.agents.body.values import symbol_of
from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_literal, parse_term
from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.python.agent import Literal, literal_of, term_of
from jacaros.agents.terms.substitution import rename, resolve
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Term, functor_of, make_list
from jacaros.artifacts.env.values import Atom, plain
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import suggestion


class LiteralText(str):
    """A belief or goal as text. Given to an agent again, it is exactly this literal, whatever its strings contain."""

    __slots__ = ("term",)

    term: Term

    def __new__(cls, term: Term) -> "LiteralText":
        written = super().__new__(cls, text(term))
        written.term = term
        return written

    @property
    def literal(self) -> Literal:
        """Its functor, arguments and annotations as Python values."""
        return literal_of(self.term)

    def __reduce__(self) -> tuple[Any, ...]:
        return str, (str(self),)


@dataclass(frozen=True, slots=True)
class Given:
    """A term from Python code.

    Attributes:
        term: the term, which shares no variable with others.
        written: the text that was given, or empty.
        unknown: its variables without a value, by name.
    """

    term: Term
    written: str
    unknown: Variables

    @property
    def text(self) -> str:
        """The text for messages."""
        return self.written or text(excerpt(self.term))


def read_given(
    given: object,
    arguments: Sequence[object] = (),
    values: Mapping[str, object] | None = None,
    parse: Callable[[str], nodes.Term] = parse_literal,
) -> Given:
    """Return the term of what Python code gives; *parse* reads a text.

    Raises:
        AslError: the text has errors.
        UsageError: arguments follow a text that is not a name, a value has no variable, or data is not a literal.
        ValueError: a value contains itself, or is nested deeper than 200 levels.
    """
    if type(given) is str and not arguments:
        return _of_text(given, values or {}, parse)
    for name in values or ():
        raise UsageError(
            f"unexpected keyword `{name}`: only variables of a text without arguments have values"
        )
    is_literal = parse is not parse_term
    if is_literal and type(given) is tuple and given and not arguments:
        term = _structure(*given)
    else:
        term = _structure(given, *arguments) if arguments else _value(given)
    if is_literal and functor_of(term) is None:
        raise UsageError(f"expected a literal, found {text(excerpt(term))}")
    return Given(term, "", Variables())


def _of_text(written: str, values: Mapping[str, object], parse: Callable[[str], nodes.Term]) -> Given:
    names = Variables()
    term = lower(parse(written), names.__getitem__)
    for name, value in values.items():
        if name not in names:
            otherwise = "pass arguments by position, or values of variables in the text: X=..."
            help = suggestion(name.capitalize(), names, otherwise)
            raise UsageError(f"`{written}` has no variable `{name}`\n  = help: {help}")
        names.pop(name).ref = _value(value)
    return Given(resolve(term), "" if values else written, names)


def _structure(name: object, *arguments: object) -> Term:
    if not _is_name(name):
        raise UsageError(
            f"expected a name before the arguments, found `{name}`\n"
            "  = help: to give values to the variables of a text, name them: X=..."
        )
    symbol = symbol_of(str(name), len(arguments))
    return (symbol, *map(_value, arguments)) if arguments else symbol


def _is_name(given: object) -> bool:
    return isinstance(given, Atom) or (type(given) is str and symbol_of(given, 1).name[0] != "'")


def _value(value: object) -> Term:
    """Return the term of a value. Lists may contain literals, like contents of messages."""
    if isinstance(value, LiteralText):
        return rename(value.term)
    if type(value) is list and any(isinstance(each, (Literal, LiteralText)) for each in value):
        return make_list(map(_value, value))
    return term_of(value if isinstance(value, Literal) else plain(value))


# Before names took arguments, positions had other meanings. A text that is not a name shows that they are meant.


def by_position(given: object, arguments: tuple[object, ...], name: str, default: Any) -> tuple[Any, Any]:
    """Return the arguments of *given*, and the value of an option that older programs pass by position."""
    if len(arguments) != 1 or _is_name(given):
        return arguments, default
    warnings.warn(f"pass {name} by keyword: {name}=...", DeprecationWarning, stacklevel=3)
    return (), arguments[0]


def each_given(given: object, arguments: tuple[object, ...], values: Mapping[str, object]) -> list[Given]:
    """Return the literal, or the several ones that older programs pass in one call."""
    if not arguments or _is_name(given):
        return [read_given(given, arguments, values)]
    warnings.warn("give one literal per call", DeprecationWarning, stacklevel=3)
    return [read_given(each, (), values) for each in (given, *arguments)]
