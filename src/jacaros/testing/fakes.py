"""Fakes: external actions that a test answers in place of an environment."""

from collections.abc import Callable
from typing import NamedTuple

from jacaros.bdi.state.act import Act, Completion
from jacaros.terms.substitution import free_variables, rename, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import ACTION, String, Term, atom, functor, functor_of

ERROR_MSG = functor("error_msg", 1)
REASON = functor("env_failure_reason", 1)

STOP = ".stopMAS"

Complete = Callable[[int, Completion], None]
Later = Callable[[float, Callable[[], None]], object]


class _Fake(NamedTuple):
    pattern: Term
    outcome: Term


class Fakes:
    """The faked actions of one agent, and all actions that it has begun.

    Args:
        complete: tells the agent the end of an act.
        later: calls a function after so many seconds of the run's clock.

    Attributes:
        acts: every action begun, faked or not, oldest first; outputs that the fake gave are filled in.
    """

    def __init__(self, complete: Complete, later: Later) -> None:
        self._complete = complete
        self._later = later
        self._fakes: list[_Fake] = []
        self.acts: list[Term] = []
        self._fakes_stop = False

    def add(self, pattern: Term, outcome: Term = None) -> None:
        """Answer actions that match *pattern*; of several fakes the last one added is taken.

        Values that stand in the pattern where the action has an unbound variable become its outputs.

        Args:
            pattern: an atom or structure; ``.stopMAS`` stands for all its forms.
            outcome: ``done`` (the default), ``after(Ms)``, ``failed(Reason)``, ``failed(Reason, Message)`` or ``never``.

        Raises:
            ValueError: there is no such outcome.
        """
        outcome = atom("done") if outcome is None else resolve(outcome)
        if not _is_outcome(outcome):
            raise ValueError(
                f"{text(outcome)} is no outcome of a fake: done, after(Ms), failed(Reason), failed(Reason, Message), never"
            )
        symbol = functor_of(pattern)
        if symbol is None or (symbol.name[:1] == "." and symbol.name != STOP):
            raise ValueError(f"{text(pattern)} is no external action")
        if symbol.name == STOP:
            self._fakes_stop = True
            return
        self._fakes.append(_Fake(rename(pattern), outcome))

    def begin(self, act: Act) -> bool:
        """Answer an act; False when no fake is for it."""
        term = (act.functor, *act.arguments) if act.arguments else act.functor
        variables = free_variables(term)
        trail = Trail()
        for fake in reversed(self._fakes):
            if not unify(rename(fake.pattern), term, trail):
                undo(trail, 0)
                continue
            values = [(variable, resolve(variable)) for variable in variables]
            self.acts.append(resolve(term))
            undo(trail, 0)
            self._answer(act.id, fake.outcome, tuple((v, value) for v, value in values if value is not v))
            return True
        self.acts.append(term)
        return False

    def stop(self, delay: float, exit_code: int) -> bool:
        """Take note of ``.stopMAS``; False when it is not faked, and ends the run."""
        if self._fakes_stop:
            given = [delay * 1000.0, float(exit_code)] if exit_code else [delay * 1000.0] if delay else []
            symbol = functor(STOP, len(given), kind=ACTION)
            self.acts.append((symbol, *given) if given else symbol)
        return self._fakes_stop

    def _answer(self, number: int, outcome: Term, outputs: tuple[tuple[Term, Term], ...]) -> None:
        done = Completion(True, outputs)
        if outcome is atom("done"):
            self._complete(number, done)
        elif outcome is not atom("never"):
            if outcome[0].name == "after":
                self._later(outcome[1] / 1000.0, lambda: self._complete(number, done))
            else:
                self._complete(number, failed(*outcome[1:]))


def failed(reason: Term, message: Term = None) -> Completion:
    """The end of an action that failed for this reason, told as environments tell it."""
    told = String(text(reason)) if message is None else String(message)
    return Completion(False, (), ((ERROR_MSG, told), (REASON, reason)))


def _is_outcome(term: Term) -> bool:
    symbol = functor_of(term)
    if symbol is None:
        return False
    if (symbol.name, symbol.arity) == ("after", 1):
        return isinstance(term[1], float)
    if (symbol.name, symbol.arity) == ("failed", 2):
        return isinstance(term[2], str)
    return (symbol.name, symbol.arity) in {("done", 0), ("never", 0), ("failed", 1)}
