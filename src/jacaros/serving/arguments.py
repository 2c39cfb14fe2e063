"""Arguments of offers as JSON data, and as terms.

=================  ====================================================================
kind               data
=================  ====================================================================
string, atom       string
number, integer    number
boolean            ``true``, ``false``
list               list of any data
any                any data: strings are strings, ``{"atom": "kitchen"}`` is an atom, and
                   ``{"functor": "at", "arguments": [1, 2]}`` a structure
=================  ====================================================================
"""

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from typing import Any

from jacaros.agents.body.values import UNKEPT, to_term, to_value
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import Variables, lower_value
from jacaros.agents.language.offers import Offer, Parameter
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import is_ground, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    FALSE,
    NUMBERS,
    TRUE,
    Functor,
    String,
    Term,
    Var,
    bare,
    double,
    functor,
    is_list,
)
from jacaros.artifacts.env.values import Atom, Out, Structure
from jacaros.serving.callers import RequestError, check_text

Data = Any
"""JSON data: None, Booleans, numbers, strings, lists, and dictionaries with strings as keys."""
Arguments = Mapping[str, Data] | Sequence[Data]
"""Arguments as JSON data, by name or in order."""
DEEPEST = 20
"""Maximum depth of data."""
MOST = 10_000
"""Maximum number of elements of data, and of characters of its strings."""


def terms_of(offer: Offer, given: Arguments) -> list[Term]:
    """Return the arguments of an offer as terms; results are variables.

    Args:
        offer: what is offered.
        given: the inputs, by name or in order.

    Raises:
        RequestError: one is missing, unknown, or of the wrong kind; the text names all.
    """
    inputs = offer.inputs
    if not isinstance(given, Mapping):
        if len(given) != len(inputs):
            raise _invalid(offer, [f"expected {len(inputs)} arguments, not {len(given)}"])
        given = {each.name: value for each, value in zip(inputs, given, strict=True)}
    names = {each.name for each in inputs}
    wrong = [f"unknown argument `{name[:80]}`" for name in given if name not in names]
    terms: list[Term] = []
    for each in offer.parameters:
        if each.output:
            terms.append(Var())
        elif each.name not in given:
            wrong.append(f"`{each.name}` is missing")
        else:
            try:
                terms.append(term_of(given[each.name], each))
            except ValueError as error:
                wrong.append(f"`{each.name}` {error}")
    if wrong:
        raise _invalid(offer, wrong)
    return terms


def fitting(offers: Sequence[Offer], given: Arguments) -> tuple[Offer, list[Term]]:
    """Return the one of the offers of a name that data fits by number, names and kinds, and its arguments as terms.

    Raises:
        RequestError: data fits none, or more than one.
    """
    near = [each for each in offers if len(offers) == 1 or _has_form(each, given)]
    if len(near) > 1:
        near = [each for each in near if _fits(each, given)]
    if len(near) == 1:
        return near[0], terms_of(near[0], given)
    forms = " or ".join(map(str, near or offers))
    if near:
        help = f"name it `{near[0].key}`, or write the {near[0].what} as text"
        raise RequestError("invalid_arguments", f"ambiguous: these arguments fit {forms}; {help}")
    raise RequestError("invalid_arguments", f"expected {forms}")


def _has_form(offer: Offer, given: Arguments) -> bool:
    if isinstance(given, Mapping):
        return given.keys() == {each.name for each in offer.inputs}
    return len(given) == len(offer.inputs)


def _fits(offer: Offer, given: Arguments) -> bool:
    try:
        terms_of(offer, given)
    except RequestError:
        return False
    return True


def called(offer: Offer, offers: Iterable[Offer]) -> str:
    """Return by which name callers call one of the offers of an agent: ``deliver``, or ``deliver/2`` if several have it."""
    same = [each for each in offers if (each.what, each.name) == (offer.what, offer.name)]
    return offer.name if len(same) < 2 else offer.key


def split_key(name: str) -> tuple[str, int | None]:
    """Return functor and number of arguments of a name such as ``deliver/2``; None for any number."""
    functor, _, count = name.rpartition("/")
    return (functor, int(count)) if functor and count.isdecimal() and len(count) < 4 else (name, None)


def _invalid(offer: Offer, wrong: Sequence[str]) -> RequestError:
    return RequestError("invalid_arguments", f"{'; '.join(wrong)}; expected {offer}")


def term_of(value: Data, parameter: Parameter) -> Term:
    """Return data as a term of the parameter's kind.

    Raises:
        ValueError: it is of another kind, or too large.
    """
    found = _plain(value, [0])
    term = to_term(Atom(found) if parameter.kind == "atom" and type(found) is str else found, UNKEPT)
    check_term(term, parameter)
    return term


def check_term(term: Term, parameter: Parameter) -> None:
    """Check that a term is of the parameter's kind.

    Raises:
        ValueError: it is not. The text says what it must be.
    """
    kind, is_number = term.__class__, term.__class__ in NUMBERS
    fits = {
        "string": kind is String,
        "atom": kind is Functor,
        "boolean": term is TRUE or term is FALSE,
        "list": is_list(term),
        "number": is_number,
        "integer": is_number and double(term).is_integer(),
    }.get(parameter.kind, True)
    if parameter.choices and (not fits or to_value(term) not in parameter.choices):
        raise ValueError(f"must be one of {', '.join(parameter.choices)}")
    if not fits:
        raise ValueError(f"must be of the kind {parameter.kind}")
    least, most = parameter.least, parameter.most
    if least is not None and most is not None and not least <= double(term) <= most:
        raise ValueError(f"must be from {least:g} to {most:g}")


def _plain(value: Data, count: list[int], depth: int = 0) -> Any:
    """Return data as a plain value of the environment."""
    count[0] += len(value) if isinstance(value, str | list | dict) else 1
    if depth > DEEPEST or count[0] > MOST:
        raise ValueError("is too deep or too large")
    if isinstance(value, list):
        return [_plain(each, count, depth + 1) for each in value]
    if isinstance(value, dict):
        return _compound(value, count, depth)
    if isinstance(value, int | float) and not _is_finite(value):
        raise ValueError("must be finite")
    if value is None:
        raise ValueError("must not be null")
    return value


def _is_finite(value: float) -> bool:
    try:
        return isfinite(value)
    except OverflowError:  # an integer that no float can represent
        return False


def _compound(value: dict[str, Data], count: list[int], depth: int) -> Any:
    match value:
        case {"atom": str(name)} if len(value) == 1 and name:
            return Atom(name)
        case {"functor": str(name), "arguments": [_, *_] as arguments} if len(value) == 2 and name:
            return Structure(name, tuple(_plain(each, count, depth + 1) for each in arguments))
    raise ValueError('has an object that is neither {"atom": …} nor {"functor": …, "arguments": […]}')


def literal_of(offer: Offer, arguments: Sequence[Term]) -> Term:
    """Return the literal of an offer with these arguments."""
    symbol = functor(offer.name, len(arguments))
    return (symbol, *arguments) if arguments else symbol


def parsed(written: str) -> tuple[str, list[Term], dict[str, Term]]:
    """Parse a literal. Return its functor, its arguments, and its variables by name.

    Raises:
        RequestError: it is too long, or not a literal.
    """
    names = Variables()
    try:
        term = bare(lower_value(parse_literal(check_text(written)), names.__getitem__))
    except (AslError, ArithmeticFault, RecursionError) as error:
        known = error.diagnostics if isinstance(error, AslError) else ()
        first = known[0].message if known else str(error).partition("\n")[0] or "nested too deeply"
        raise RequestError("invalid_arguments", f"not a literal: {first}") from None
    symbol, *arguments = term if term.__class__ is tuple else (term,)
    if symbol.negated or symbol.namespace:
        raise RequestError("not_offered", f"not offered: `{written[:80]}`")
    return symbol.name, arguments, dict(names.items())


def check_terms(offer: Offer, arguments: Sequence[Term], open_inputs: bool = False) -> None:
    """Check the arguments of a parsed literal.

    Raises:
        RequestError: one is of the wrong kind. A result must be a variable.
    """
    wrong = []
    for each, term in zip(offer.parameters, arguments, strict=True):
        if term.__class__ is Var and (each.output or open_inputs):
            continue
        try:
            if not (each.output or open_inputs or is_ground(term)):
                raise ValueError("must not contain a variable")
            check_term(term, each)
        except ValueError as error:
            wrong.append(f"`{each.name}` {error}")
    if wrong:
        raise _invalid(offer, wrong)


def data_of(term: Term) -> Data:
    """Return a term as JSON data, as for the kind ``any``; atoms outside structures are strings."""
    return _data(to_value(resolve(term)))


def _data(value: Any) -> Data:
    if isinstance(value, float) and not isfinite(value):
        return str(value)  # JSON has no such numbers
    if isinstance(value, bool | int | float) or value is None:
        return value
    if isinstance(value, str):
        return str(value)
    if isinstance(value, list | tuple):
        return [_data(each) for each in value]
    if isinstance(value, Structure):
        return {"functor": value.functor, "arguments": [_data(each) for each in value.arguments]}
    if isinstance(value, dict):
        return {str(key): _data(each) for key, each in value.items()}
    return None if isinstance(value, Out) else str(value)


def named(offer: Offer, arguments: Sequence[Term]) -> dict[str, Data]:
    """Return the arguments of an offer by name, as data."""
    return {each.name: data_of(term) for each, term in zip(offer.parameters, arguments, strict=True)}


def schema_of(parameters: Sequence[Parameter]) -> dict[str, Any]:
    """Return the JSON schema of arguments."""
    return {
        "type": "object",
        "properties": {each.name: _schema(each) for each in parameters},
        "required": [each.name for each in parameters],
        "additionalProperties": False,
    }


def results_schema(offer: Offer) -> dict[str, Any]:
    """Return the JSON schema of results, of which a program may leave some out."""
    return schema_of([each for each in offer.parameters if each.output]) | {"required": []}


def described(offer: Offer) -> dict[str, Any]:
    """Return what is offered as JSON data, with the JSON schemas of its arguments and results."""
    found: dict[str, Any] = {
        "what": offer.what,
        "name": offer.name,
        "form": str(offer),
        "doc": offer.doc,
        "roles": sorted(offer.roles),
        "arguments": schema_of(offer.inputs),
    }
    if offer.what in ("goal", "question"):
        found["results"] = results_schema(offer)
    if offer.what == "goal":
        found |= {"at_most": offer.at_most, "when_busy": offer.when_busy, "when_left": offer.when_left}
        found["hints"] = sorted(offer.hints)
    return found


_TYPES = {"atom": "string", "list": "array"}


def _schema(parameter: Parameter) -> dict[str, Any]:
    schema: dict[str, Any] = (
        {} if parameter.kind == "any" else {"type": _TYPES.get(parameter.kind, parameter.kind)}
    )
    if parameter.choices:
        schema["enum"] = list(parameter.choices)
    if parameter.least is not None:
        schema["minimum"] = parameter.least
    if parameter.most is not None:
        schema["maximum"] = parameter.most
    if parameter.doc:
        schema["description"] = parameter.doc
    return schema


def reasons_of(terms: Sequence[Term]) -> list[str]:
    """Return reason terms as text, without those that only say that there was a failure."""
    return [
        text(each)
        for each in terms
        if not (each.__class__ is tuple and each[0].name in ("error_msg", "code_file"))
    ]
