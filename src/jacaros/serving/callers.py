"""Callers of agents: who asks, in which roles, and how much."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from jacaros.agents.language.offers import OBSERVER, OPERATOR, USER, Offer
from jacaros.agents.terms.values import Term
from jacaros.runtime.errors import JacarosError

_INCLUDED = {OPERATOR: {USER, OBSERVER}, USER: {OBSERVER}}
LONGEST = 2_000
"""Maximum number of characters of a text that is parsed: it takes about 10 ms."""
PER_SECOND, BURST = 1_000.0, 2_000.0
"""Default limits of one session: requests per second, and at once."""


class RequestError(JacarosError):
    """A request that has no effect.

    Attributes:
        code: ``unknown_agent``, ``unknown_goal``, ``unknown_artifact``, ``not_offered``, ``not_permitted``,
            ``invalid_arguments``, ``too_large``, ``too_many_requests``, ``unanswerable`` or ``ended``.
        reasons: terms that say why, such as ``refused(low_battery)``.
    """

    def __init__(self, code: str, message: str, reasons: Iterable[Term] = ()) -> None:
        super().__init__(message)
        self.code, self.message, self.reasons = code, message, tuple(reasons)


@dataclass(frozen=True)
class Caller:
    """Who asks.

    Attributes:
        name: name of the person or program, such as ``anna``.
        door: the way by which it asks: ``http``, ``mcp``, ``ros``, ``page`` or ``python``.
        roles: its roles; see `jacaros.agents.language.offers`.
    """

    name: str
    door: str
    roles: frozenset[str]

    def __str__(self) -> str:
        return f"{self.door}:{self.name}"

    def has(self, roles: Iterable[str]) -> bool:
        """Return whether it has one of these roles. An operator has them all."""
        own = self.roles.union(*(_INCLUDED.get(each, ()) for each in self.roles))
        return OPERATOR in own or not own.isdisjoint(roles)

    def may(self, offer: Offer) -> bool:
        """Return whether something is offered to it."""
        return self.has(offer.roles)

    def sees(self, owner: "Caller") -> bool:
        """Return whether it sees the goals of a caller: its own, or all for an operator."""
        return self == owner or self.has((OPERATOR,))

    def require(self, *roles: str) -> None:
        """Check that it has one of these roles.

        Raises:
            RequestError: it has not.
        """
        if not self.has(roles):
            raise RequestError("not_permitted", f"{self} needs the role {' or '.join(roles)}")


class Allowance:
    """Limits the requests of one session.

    Args:
        time: returns seconds of a steady clock.
        per_second: requests per second in the long run.
        burst: requests at once.
    """

    def __init__(
        self, time: Callable[[], float], per_second: float = PER_SECOND, burst: float = BURST
    ) -> None:
        self._time, self._per_second, self._burst = time, per_second, burst
        self._left, self._at = burst, time()

    def spend(self, requests: float = 1.0) -> None:
        """Spend requests.

        Raises:
            RequestError: there were too many.
        """
        now = self._time()
        self._left = min(self._burst, self._left + (now - self._at) * self._per_second)
        self._at = now
        if self._left < requests:
            raise RequestError("too_many_requests", f"more than {self._per_second:g} requests per second")
        self._left -= requests


def check_text(text: str) -> str:
    """Return a text that is to be parsed.

    Raises:
        RequestError: it is too long.
    """
    if len(text) > LONGEST:
        raise RequestError("too_large", f"a text has {len(text)} characters; the limit is {LONGEST}")
    return text
