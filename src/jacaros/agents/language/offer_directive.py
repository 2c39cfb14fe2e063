"""The directive ``offer``, see `jacaros.agents.language.offers`.

>>> from jacaros.agents.language.loader import parse_term
>>> print(offer_of(parse_term("offer(tell, closed(room([lab, hall])))")))
closed(room: lab | hall)
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import reduce
from typing import Any, Final, TypeGuard

from jacaros.agents.language import nodes
from jacaros.agents.language.offers import KINDS, OBSERVER, USER, WHAT, Offer, Parameter
from jacaros.agents.language.program_parser import WrongDirective
from jacaros.runtime.files.texts import suggestion

_POLICIES: Final[dict[str, tuple[str, ...]]] = {
    "when_busy": ("refuse", "wait", "replace"),
    "when_left": ("continue", "cancel"),
}
_HINTS: Final = ("destructive", "idempotent")
_OPTIONS: Final = ("doc", "role", "at_most", *_POLICIES, *_HINTS)
_EXAMPLE: Final = '{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel.")) }'


def offer_of(directive: nodes.Literal) -> Offer:
    """Return what a directive ``offer`` declares.

    Raises:
        WrongDirective: it is used wrongly.
    """
    match directive.arguments:
        case (nodes.Literal(what, ()), nodes.Literal() as pattern, *options) if what in WHAT:
            pass
        case (nodes.Literal(what, ()), *_) if what not in WHAT:
            help = suggestion(what, WHAT, f"use one of {', '.join(WHAT)}")
            raise WrongDirective(f"nothing is offered as `{what}`", help)
        case _:
            message = "`offer` expects what is offered, its form and options"
            raise WrongDirective(message, f"write `{_EXAMPLE}`")
    if pattern.negated or pattern.namespace is not None:
        raise WrongDirective("only literals of the default namespace can be offered", None, pattern.span)
    parameters = tuple(map(_parameter, pattern.arguments))
    names = [each.name for each in parameters]
    if twice := next((each for each in names if names.count(each) > 1), ""):
        message = f"two arguments have the name `{twice}`"
        raise WrongDirective(message, "give each a name of its own", pattern.span)
    if what not in ("question", "goal") and any(each.output for each in parameters):
        raise WrongDirective(f"a {what} has no results", "leave out `out`", pattern.span)
    roles = frozenset({USER if what in ("goal", "tell") else OBSERVER})
    return reduce(
        _with_option, options, Offer(what, pattern.functor, parameters, "", roles, span=directive.span)
    )


def _with_option(offer: Offer, option: nodes.Term) -> Offer:
    name = option.functor if isinstance(option, nodes.Literal) else ""
    match option:
        case nodes.Literal("doc", (nodes.String(text),)):
            return replace(offer, doc=text)
        case nodes.Literal("role", (nodes.Literal() | nodes.ListTerm() as given,)):
            return replace(offer, roles=frozenset(_names(given)))
        case nodes.Literal("at_most", (nodes.Number(count),)) if count >= 1 and count == int(count):
            return replace(offer, at_most=int(count))
        case nodes.Literal("at_most", (nodes.Literal("any", ()),)):
            return replace(offer, at_most=None)
        case nodes.Literal("destructive" | "idempotent", ()):
            return replace(offer, hints=offer.hints | {name})
        case nodes.Literal(_, (nodes.Literal(policy, ()),)) if policy in _POLICIES.get(name, ()):
            chosen: dict[str, Any] = {name: policy}
            return replace(offer, **chosen)
    if name in _POLICIES:
        help = f"write `{name}({' | '.join(_POLICIES[name])})`"
    else:
        help = suggestion(name, _OPTIONS, f"options are {', '.join(_OPTIONS)}")
    raise WrongDirective(f"unknown option of an offer: `{name or '?'}`", help, option.span)


def _names(given: nodes.Literal | nodes.ListTerm) -> Iterator[str]:
    for each in given.items if isinstance(given, nodes.ListTerm) else (given,):
        if not (isinstance(each, nodes.Literal) and not each.arguments):
            help = "write `role(nurse)` or `role([nurse, cook])`"
            raise WrongDirective("a role must be an atom", help, each.span)
        yield each.functor


def _parameter(term: nodes.Term) -> Parameter:
    match term:
        case nodes.Literal(name, (), False):
            return Parameter(name)
        case nodes.Literal(name, (kind,), False):
            return _kind(Parameter(name), kind)
        case nodes.Literal(name, (kind, nodes.String(doc)), False):
            return replace(_kind(Parameter(name), kind), doc=doc)
    message = "an argument of an offer is its name with its kind"
    raise WrongDirective(message, "write `parcel(string)`", term.span)


def _kind(parameter: Parameter, kind: nodes.Term) -> Parameter:
    match kind:
        case nodes.Literal("out", ()):
            return replace(parameter, output=True)
        case nodes.Literal("out", (inner,)):
            return replace(_kind(parameter, inner), output=True)
        case nodes.Literal("number" | "integer", (nodes.Number(least), nodes.Number(most))) if least <= most:
            return replace(parameter, kind=kind.functor, least=least, most=most)
        case nodes.Literal(name, ()) if name in KINDS:
            return replace(parameter, kind=name)
        case nodes.ListTerm((_, *_) as items, None):
            atoms = [each.functor.strip("'") for each in items if _is_atom(each)]
            strings = [each.value for each in items if isinstance(each, nodes.String)]
            if len(atoms) == len(items):
                return replace(parameter, kind="atom", choices=tuple(atoms))
            if len(strings) == len(items):
                return replace(parameter, kind="string", choices=tuple(strings))
    help = (
        f"write one of {', '.join(KINDS)}, `number(0, 100)`, a list of atoms, or `out(number)` for a result"
    )
    raise WrongDirective(f"unknown kind of the argument `{parameter.name}`", help, kind.span)


def _is_atom(term: nodes.Term) -> TypeGuard[nodes.Literal]:
    return isinstance(term, nodes.Literal) and not term.arguments
