"""The histories that an agent keeps: those that its programs declare, and those that focused artifacts ask for."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from jacaros.asl import nodes
from jacaros.asl.directives.history import format_history
from jacaros.asl.lowering import lower_value
from jacaros.bdi.rules.past import History, is_kept
from jacaros.bdi.state.belief_base import Item, Row
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.terms.values import Functor, Term, functor_of


class Histories:
    """All histories of one agent.

    Changes wait until `note` gives them a time.

    Args:
        agent: whose they are.
        changed: called when a first change waits.

    Attributes:
        declared: what programs declare, by its text.
    """

    def __init__(self, agent: Circumstance, changed: Callable[[], None]) -> None:
        self.declared: dict[str, nodes.History] = {}
        self._agent, self._changed = agent, changed
        self._observed: dict[tuple[str | None, str], float] = {}
        self._histories: dict[Functor, History] = {}
        self._waiting: list[tuple[History, Row]] = []

    def keep(self, declared: Iterable[nodes.History]) -> None:
        """Keep additional histories; for the same beliefs, the longer window counts."""
        self.declared |= {format_history(each): each for each in declared}
        self.arrange()

    def observe(self, namespace: str | None, histories: Mapping[str, float]) -> None:
        """Keep the histories of beliefs with any number of arguments, which artifacts ask for: seconds by name."""
        for name, window in histories.items():
            self._observed[namespace, name] = max(window, self._observed.get((namespace, name), 0.0))
        self.arrange()

    def arrange(self) -> None:
        """Keep the histories that are declared or observed, and no others."""
        windows = dict.fromkeys((*self._histories, *self._agent.beliefs), 0.0)
        for each in self.declared.values():
            symbol = functor_of(lower_value(each.belief))
            assert symbol is not None
            windows[symbol] = max(each.window, windows.get(symbol, 0.0))
        for symbol in windows:
            windows[symbol] = max(windows[symbol], self._observed_window(symbol))
        self._histories = {
            symbol: self._history(symbol, window) for symbol, window in windows.items() if window
        }

    def _observed_window(self, symbol: Functor) -> float:
        return self._observed.get((symbol.namespace, symbol.name), 0.0)

    def _history(self, symbol: Functor, window: float) -> History:
        """Return the history of beliefs, creating it if necessary."""
        history = self._histories.get(symbol)
        if history is None:
            history = History(symbol, window)
            self._look_at(history)
        history.window = window
        return history

    def _look_at(self, history: History) -> None:
        """Compare a history with the present beliefs."""
        for row in history.rows(self._agent.beliefs[history.functor]):
            self._change(history, row)

    def _change(self, history: History, row: Row) -> None:
        if not self._waiting:
            self._changed()
        self._waiting.append((history, row))

    def heard(self, symbol: Functor, row: Row) -> None:
        """Note a belief that may have been added or deleted."""
        history = self._histories.get(symbol)
        if history is not None:
            self._change(history, row)
        elif self._observed and (window := self._observed_window(symbol)):
            self._histories[symbol] = self._history(symbol, window)  # which looks at this belief, too

    def note(self, now: float) -> None:
        """Write pending changes into the histories."""
        waiting, self._waiting = self._waiting, []
        for history, row in waiting:
            if is_kept(row):
                history.note(self._agent.beliefs[history.functor], row, now)

    def past(self, symbol: Functor, milliseconds: Term, now: float) -> list[Item] | None:
        """Return what was believed that time before *now*, newest first; None if no history of such beliefs is kept."""
        history = self._histories.get(symbol)
        if history is None:
            return None
        self.note(now)
        if not isinstance(milliseconds, float) or not 0.0 <= milliseconds <= history.window * 1000.0:
            return []
        return history.at(now - milliseconds / 1000.0)

    def stored(self) -> dict[str, Any]:
        """Return the remains of the past as data."""
        kept = [(symbol, history.state()) for symbol, history in self._histories.items()]
        return {"kept": kept, "observed": list(self._observed.items())}

    def resume(self, held: dict[str, Any]) -> None:
        """Continue from what was `stored` of an agent."""
        for (namespace, name), window in held["observed"]:
            self.observe(namespace, {name: window})
        for symbol, state in held["kept"]:
            history = self._histories.get(symbol)
            if history is not None:
                history.resume(state)
                self._look_at(history)
