"""What a test sees of an agent, and how it answers: the actions that the agent has begun, its messages, and fakes.

A fake answers external actions in place of an environment.
"""

from collections.abc import Callable
from typing import NamedTuple

from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import lower_value
from jacaros.bdi.state.act import Act, Completion
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import References, to_term, to_value
from jacaros.terms.substitution import free_variables, rename, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import ACTION, String, Term, Var, atom, functor, functor_of

ERROR_MSG = functor("error_msg", 1)
REASON = functor("env_failure_reason", 1)
STOP = ".stopMAS"

Action = Callable[..., object]
"""Answers an external action, see `RecordedAct.answer`."""
Complete = Callable[[int, Completion], None]
Later = Callable[[float, Callable[[], None]], object]


class ActionFailed(Exception):
    """Raised by a faked action to let the step fail.

    Args:
        reason: the reason term, as text: ``blocked(wall)`` reaches the plan as ``env_failure_reason(blocked(wall))``.
        message: for people; the reason unless given.
    """

    def __init__(self, reason: str, message: str | None = None) -> None:
        super().__init__(message or reason)
        self.reason, self.message = reason, message


class RecordedAct:
    """An external action that the agent has begun.

    Attributes:
        name: of the action.
        arguments: plain values (numbers, strings, `jacaros.env.values.Atom`, `Structure`, lists); None for an output.
        pending: whether its end is still to come.
        cancelled: the intention behind it was dropped.
        paused: the intention behind it is suspended.
    """

    def __init__(self, act: Act, complete: Complete) -> None:
        self._act = act
        self._complete = complete
        self._term: Term = (act.functor, *act.arguments) if act.arguments else act.functor
        self._outputs = free_variables(self._term)
        self.name = act.functor.name
        self.arguments = tuple(None if a.__class__ is Var else to_value(a) for a in act.arguments)
        self.pending = True
        self.cancelled = False
        self.paused = False

    @property
    def term(self) -> Term:
        """The action as a term."""
        return self._term

    def complete(self, *outputs: object) -> None:
        """Let it succeed; *outputs* are the values of its unbound variables, in order.

        Raises:
            ValueError: it has ended before, or the number of outputs is not that of its unbound variables.
        """
        if outputs and len(outputs) != len(self._outputs):
            raise ValueError(f"{self} has {len(self._outputs)} unbound variables, not {len(outputs)}")
        values = [
            (variable, to_term(value, References()))
            for variable, value in zip(self._outputs, outputs, strict=False)
        ]
        self._end(Completion(True, tuple(values)))

    def fail(self, reason: str = "failed", message: str | None = None) -> None:
        """Let it fail, with a reason term as text, and a message for people.

        Raises:
            ValueError: it has ended before.
        """
        self._end(failed(lower_value(parse_term(reason)), message))

    def _end(self, completion: Completion) -> None:
        if not self.pending:
            raise ValueError(f"{self} has ended{' with its intention' if self.cancelled else ''}")
        self.pending = False
        self._complete(self._act.id, completion)

    def answer(self, function: Action) -> None:
        """Let a function decide: it is called with the arguments that have values, and gives the outputs.

        One output is what it returns, several are a tuple; without outputs False means that the action fails.
        What it raises beside `ActionFailed` is a mistake of the test, and is raised by `AgentHarness.run`.
        """
        values = [
            a
            for a, term in zip(self.arguments, self._act.arguments, strict=True)
            if term.__class__ is not Var
        ]
        try:
            result = function(*values)
        except ActionFailed as end:
            self.fail(end.reason, end.message)
            return
        if not self._outputs:
            self.fail() if result is False else self.complete()
        elif len(self._outputs) == 1:
            self.complete(result)
        else:
            self.complete(*(result if isinstance(result, tuple) else (result,)))

    def __str__(self) -> str:
        return text(self._term)

    def __repr__(self) -> str:
        return f"<act {self}{' pending' if self.pending else ''}>"


class SentMessage:
    """A message that the agent has sent.

    Attributes:
        receiver: name of the agent it is for.
        performative: such as ``tell``.
        content: as text.
    """

    def __init__(self, message: SpeechAct) -> None:
        self.receiver = message.receiver
        self.performative = message.performative
        self.content = text(message.content)
        self.term = message.content

    def __repr__(self) -> str:
        return f".send({self.receiver}, {self.performative}, {self.content})"


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
