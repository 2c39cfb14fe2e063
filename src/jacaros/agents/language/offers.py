"""Offers: what a program declares for callers outside, with the directive ``offer``.

    { offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room."), role(nurse)) }
    { offer(belief, battery(level(number(0, 100)))) }

What is not declared cannot be reached from outside.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("r.asl", "{ offer(goal, go(room([lab, hall]), metres(out(number)))) } +!go(_, 3).")
>>> print(program.offers[0])
go(room: lab | hall, -> metres: number)
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Final, TypeGuard

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Span
from jacaros.agents.language.program_parser import WrongDirective
from jacaros.runtime.files.texts import suggestion

WHAT: Final = ("goal", "belief", "question", "event", "tell")
"""What can be offered: goals to pursue, beliefs to look at, questions to ask, events that are announced, and beliefs that
callers may tell.
"""
KINDS: Final = ("string", "atom", "number", "integer", "boolean", "list", "any")
"""Kinds of arguments."""
OBSERVER, USER, OPERATOR = "observer", "user", "operator"
"""Roles that always exist. An observer may look; a user may also give goals and tell beliefs; an operator may all."""
_POLICIES: Final[dict[str, tuple[str, ...]]] = {
    "when_busy": ("refuse", "wait", "replace"),
    "when_left": ("continue", "cancel"),
}
_HINTS: Final = ("destructive", "idempotent")
_OPTIONS: Final = ("doc", "role", "at_most", *_POLICIES, *_HINTS)
_EXAMPLE: Final = '{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel.")) }'


@dataclass(frozen=True, slots=True)
class Parameter:
    """An argument of what is offered.

    Attributes:
        name: its name for callers.
        kind: one of `KINDS`.
        choices: its possible values, if they are listed.
        least, most: the limits of a number; None for no limit.
        output: whether the program sets it, as a result.
        doc: what it means.
    """

    name: str
    kind: str = "any"
    choices: tuple[str, ...] = ()
    least: float | None = None
    most: float | None = None
    output: bool = False
    doc: str = ""

    def __str__(self) -> str:
        kind = " | ".join(self.choices) or self.kind
        if self.least is not None or self.most is not None:
            kind += f" {'' if self.least is None else f'{self.least:g}'}..{'' if self.most is None else f'{self.most:g}'}"
        return f"{'-> ' * self.output}{self.name}: {kind}"


@dataclass(frozen=True, slots=True)
class Offer:
    """What a program offers to callers outside.

    Attributes:
        what: one of `WHAT`.
        name: functor of the goal, belief, question or event.
        parameters: its arguments.
        doc: what it means, for people and language models.
        roles: callers need one of these roles.
        at_most: number of goals at once, or None for any number.
        when_busy: what happens to a further one: ``refuse`` it, let it ``wait``, or let it ``replace`` the oldest.
        when_left: what happens to a goal whose caller has gone: ``continue``, or ``cancel`` it.
        hints: of ``destructive`` and ``idempotent``, those that apply.
        span: its place in the program.
    """

    what: str
    name: str
    parameters: tuple[Parameter, ...] = ()
    doc: str = ""
    roles: frozenset[str] = frozenset()
    at_most: int | None = 1
    when_busy: str = "refuse"
    when_left: str = "continue"
    hints: frozenset[str] = frozenset()
    span: Span | None = field(default=None, compare=False, repr=False)

    @property
    def key(self) -> str:
        """Functor and number of arguments, such as ``deliver/2``."""
        return f"{self.name}/{len(self.parameters)}"

    @property
    def inputs(self) -> tuple[Parameter, ...]:
        """The arguments that callers give."""
        return tuple(each for each in self.parameters if not each.output)

    def __str__(self) -> str:
        return f"{self.name}({', '.join(map(str, self.parameters))})" if self.parameters else self.name


def offer_of(directive: nodes.Literal) -> Offer:
    """Return what a directive ``offer`` declares.

    Raises:
        WrongDirective: it is used wrongly.
    """
    match directive.arguments:
        case (nodes.Literal(what, ()), nodes.Literal() as pattern, *options) if what in WHAT:
            pass
        case (nodes.Literal(what, ()), *_) if what not in WHAT:
            raise WrongDirective(
                f"nothing is offered as `{what}`", suggestion(what, WHAT, f"use one of {', '.join(WHAT)}")
            )
        case _:
            raise WrongDirective(
                "`offer` expects what is offered, its form and options", f"write `{_EXAMPLE}`"
            )
    if pattern.negated or pattern.namespace is not None:
        raise WrongDirective("only literals of the default namespace can be offered", None, pattern.span)
    parameters = tuple(map(_parameter, pattern.arguments))
    names = [each.name for each in parameters]
    for name in names:
        if names.count(name) > 1:
            raise WrongDirective(
                f"two arguments have the name `{name}`", "give each a name of its own", pattern.span
            )
    if what != "question" and what != "goal" and any(each.output for each in parameters):
        raise WrongDirective(f"a {what} has no results", "leave out `out`", pattern.span)
    default = USER if what in ("goal", "tell") else OBSERVER
    offer = Offer(what, pattern.functor, parameters, roles=frozenset({default}), span=directive.span)
    for option in options:
        offer = _with_option(offer, option)
    return offer


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
        case nodes.Literal("when_busy" | "when_left", (nodes.Literal(policy, ()),)):
            if policy in _POLICIES[name]:
                return (
                    replace(offer, when_busy=policy)
                    if name == "when_busy"
                    else replace(offer, when_left=policy)
                )
        case nodes.Literal("destructive" | "idempotent", ()):
            return replace(offer, hints=offer.hints | {name})
        case _:
            pass
    if name in _POLICIES:
        help = f"write `{name}({' | '.join(_POLICIES[name])})`"
    else:
        help = suggestion(name, _OPTIONS, f"options are {', '.join(_OPTIONS)}")
    raise WrongDirective(f"unknown option of an offer: `{name or '?'}`", help, option.span)


def _names(given: nodes.Literal | nodes.ListTerm) -> Iterator[str]:
    for each in given.items if isinstance(given, nodes.ListTerm) else (given,):
        if not (isinstance(each, nodes.Literal) and not each.arguments):
            raise WrongDirective(
                "a role must be an atom", "write `role(nurse)` or `role([nurse, cook])`", each.span
            )
        yield each.functor


def _parameter(term: nodes.Term) -> Parameter:
    match term:
        case nodes.Literal(name, (), False):
            return Parameter(name)
        case nodes.Literal(name, (kind,), False):
            return _kind(Parameter(name), kind)
        case nodes.Literal(name, (kind, nodes.String(doc)), False):
            return replace(_kind(Parameter(name), kind), doc=doc)
    raise WrongDirective(
        "an argument of an offer is its name with its kind", "write `parcel(string)`", term.span
    )


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
        case _:
            pass
    help = (
        f"write one of {', '.join(KINDS)}, `number(0, 100)`, a list of atoms, or `out(number)` for a result"
    )
    raise WrongDirective(f"unknown kind of the argument `{parameter.name}`", help, kind.span)


def _is_atom(term: nodes.Term) -> TypeGuard[nodes.Literal]:
    return isinstance(term, nodes.Literal) and not term.arguments
