"""A run whose agent offers something, on the virtual clock, and sessions of callers."""

from collections.abc import Awaitable, Callable
from typing import Any

import jacaros
from jacaros import Mas
from jacaros.serving.callers import Caller
from jacaros.serving.service import Session, service_of

PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room.")) }
{ offer(goal, count(n(number(0, 10)), next(out(number)))) }
{ offer(goal, guard, at_most(any), role(warden)) }
{ offer(goal, search, when_busy(replace)) }
{ offer(goal, wash, when_busy(wait), when_left(cancel)) }
{ offer(belief, battery(level(number))) }
{ offer(question, double(x(number), y(out(number)))) }
{ offer(question, endless(x(out(number)))) }
{ offer(question, saying(x(out(any)))) }
{ offer(tell, closed(room(atom))) }
{ offer(event, delivered(parcel(string))) }
battery(80). secret(42).
double(X, 2 * X).
endless(X) :- endless(Y) & X = Y + 1.
saying(X) :- .print(X).
+!deliver(_, Room) : closed(Room) <- .refuse(closed(Room)).
+!deliver(Parcel, _) : battery(Level) & Level > 20
  <- .wait(1000); .progress(0.5, "half way"); .wait(1000); -+battery(Level - 30); .announce(delivered(Parcel)).
+!count(N, N + 1).
+!guard <- !watch. +!watch <- .wait(100000).
@s[cleanup(tidy)] +!search <- .wait(100000).
+!tidy <- .print(tidying); .wait(500); .print(tidied).
+!wash <- .wait(1000).
+!hidden <- .print(hidden).
+closed(Room)[source(Who)] <- .print(Who, " closed ", Room).
"""

Test = Callable[..., Awaitable[None]]


class Lab:
    """A run with one agent, ``bob``.

    Attributes:
        mas: the run.
        lines: what agents print.
    """

    def __init__(self, mas: Mas, lines: list[str]) -> None:
        self.mas, self.lines = mas, lines

    def session(self, name: str = "anna", *roles: str) -> Session:
        """Open a session of a caller, by default of a user."""
        return service_of(self.mas.system).open(Caller(name, "test", frozenset(roles or ("user",))))


def run(test: Test, program: str = PROGRAM, **options: Any) -> list[str]:
    """Run a test with a `Lab`. Return what agents print."""
    lines: list[str] = []

    async def main() -> None:
        printed = lambda agent, text: lines.append(f"[{agent}] {text}")  # noqa: E731
        async with Mas(seed=1, on_print=printed, on_log=lambda text, level: None, **options) as mas:
            mas.add_agent("bob", program)
            await test(Lab(mas, lines))

    jacaros.run(main(), clock="fast")
    return lines
