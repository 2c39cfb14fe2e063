"""Parameters that were given to a run and that nobody declares: told once, since they have no effect."""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from jacaros.clock import Clock

if TYPE_CHECKING:
    from jacaros.ros.given_parameters import GivenParameters

PATIENCE = 3.0
"""Seconds of the run's clock: agents make artifacts with their first steps, too."""

_FEW = 5
"""So many names are told: a file for all nodes of a robot may have hundreds."""


class UndeclaredParameters:
    """Tells in a log which of the given parameters nobody has declared `PATIENCE` seconds after the start.

    A run that ends before that tells it at its end.

    Args:
        names: of the parameters that were given.
        given: those of our node; None while there is no node.
        clock: measures the seconds.
        log: takes one line.
    """

    def __init__(
        self,
        names: Iterable[str],
        given: "Callable[[], GivenParameters | None]",
        clock: Clock,
        log: Callable[[str], None],
    ) -> None:
        self._names, self._given, self._log = sorted(names), given, log
        self._is_told = False
        self._timer = clock.call_later(PATIENCE, self.tell)

    def tell(self) -> None:
        """Tell it, unless it is told."""
        if self._is_told:
            return
        self.close()
        given = self._given()
        unknown, known = (self._names, []) if given is None else (given.untaken(), given.known())
        if unknown:
            self._log(_text(unknown, known))

    def close(self) -> None:
        """Tell nothing any more."""
        self._is_told = True
        self._timer.cancel()


def _text(unknown: Sequence[str], known: Sequence[str]) -> str:
    from jacaros.asl.slips import close_matches  # here: only for mistakes

    several = len(unknown) > 1
    listed = ", ".join(unknown[:_FEW]) + (f" and {len(unknown) - _FEW} more" if len(unknown) > _FEW else "")
    near = [found[0] for name in unknown if (found := close_matches(name, known))]
    cure = (
        f"did you mean {', '.join(dict.fromkeys(near))}?"
        if near
        else f"a mapping file does that, parameters: {{{unknown[0].rpartition('.')[2]}: {{default: ...}}}}"
    )
    return (
        f"the parameter{'s' if several else ''} {listed} {'have' if several else 'has'} no effect: nothing here declares "
        f"{'them' if several else 'it'}; {cure}"
    )
