"""Offers: what a program declares for callers outside, with the directive ``offer``.

    { offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room."), role(nurse)) }
    { offer(belief, battery(level(number(0, 100)))) }

What is not declared cannot be reached from outside.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("r.asl", "{ offer(goal, go(room([lab, hall]), metres(out(number)))) } +!go(_, 3).")
>>> print(program.offers[0])
go(room: lab | hall, -> metres: number)
"""

from dataclasses import dataclass, field
from typing import Final

from jacaros.agents.language.diagnostics import Span

WHAT: Final = ("goal", "belief", "question", "event", "tell")
"""What can be offered: goals to pursue, beliefs to look at, questions to ask, events that are announced, and beliefs that
callers may tell.
"""
KINDS: Final = ("string", "atom", "number", "integer", "boolean", "list", "any")
"""Kinds of arguments."""
OBSERVER, USER, OPERATOR = "observer", "user", "operator"
"""Roles that always exist. An observer may look; a user may also give goals and tell beliefs; an operator may all."""


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
