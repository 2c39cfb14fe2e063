"""The budget of each page: the share of the loop's time that its commands may take."""

from collections.abc import Callable, Coroutine, Generator
from types import coroutine
from typing import Any, TypeVar

from jacaros.runtime.clock import real_time

SHARE = 0.05
"""Share of the loop's time for the commands of all pages together."""
AHEAD = 1.0
"""Seconds that a page may be ahead of its share: single commands, and several at once, are executed immediately."""

Result = TypeVar("Result")


class Allowances:
    """Divides the share among the pages."""

    def __init__(self) -> None:
        self._pages = 0
        self._inherited = 0.0

    def begin(self) -> "Allowance":
        """Return the budget of another page. It takes over debts of former pages: reconnecting gains nothing."""
        self._pages += 1
        return Allowance(self, self._inherited)

    def end(self, allowance: "Allowance") -> None:
        """A page has gone."""
        self._pages -= 1
        self._inherited = max(self._inherited, allowance.paid_at)

    def wait_for(self, seconds: float) -> float:
        """Return after how many seconds that time of the loop is earned again."""
        return seconds * self._pages / SHARE


class Allowance:
    """The budget of one page.

    Attributes:
        paid_at: real time at which the share covers everything that the page has used.
    """

    def __init__(self, all_pages: Allowances, paid_at: float) -> None:
        self._all, self.paid_at = all_pages, paid_at

    @property
    def is_used_up(self) -> bool:
        """Whether the next command has to wait."""
        return self.paid_at > real_time() + AHEAD

    def spend(self, seconds: float) -> None:
        """Note time that the page has used."""
        self.paid_at = max(self.paid_at, real_time()) + self._all.wait_for(seconds)


@coroutine
def metered(
    work: Coroutine[Any, Any, Result], spend: Callable[[float], object]
) -> Generator[Any, Any, Result]:
    """Run a coroutine, and pass the time that each of its turns on the loop takes to *spend*."""
    turn: Callable[[Any], Any] = work.send
    given: Any = None
    while True:
        begun = real_time()
        try:
            waiting = turn(given)
        except StopIteration as end:
            result: Result = end.value
            return result
        finally:
            spend(real_time() - begun)
        try:
            turn, given = work.send, (yield waiting)
        except BaseException as error:  # such as a cancellation
            turn, given = work.throw, error
