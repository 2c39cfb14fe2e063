"""The actions and messages of an agent as recorded by a test, and fake actions.

A fake answers external actions instead of an environment.
"""

from collections.abc import Callable
from typing import NamedTuple

from jacaros.agents.body.values import References, to_term, to_value
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import Act, Completion, SpeechAct
from jacaros.agents.terms.substitution import free_variables, rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import ACTION, String, Term, Var, atom, functor, functor_of

ERROR_MSG = functor("error_msg", 1)
REASON = functor("env_failure_reason", 1)
STOP = ".stopMAS"

Action = Callable[..., object]
"""A function that answers an external action; see `RecordedAct.answer`."""
Complete = Callable[[int, Completion], None]
Later = Callable[[float, Callable[[], None]], object]


def matches(pattern: Term, term: Term) -> bool:
    """Return whether a pattern unifies with a term; annotations count only if the pattern has some."""
    trail = Trail()
    found = unify(pattern, rename(term), trail)
    undo(trail, 0)
    return found


class ActionFailed(Exception):
    """Raised by a fake action to make the step fail.

    Args:
        reason: reason term as text: ``blocked(wall)`` reaches the plan as ``env_failure_reason(blocked(wall))``.
        message: message for the log (default: the reason).
    """

    def __init__(self, reason: str, message: str | None = None) -> None:
        super().__init__(message or reason)
        self.reason, self.message = reason, message


class RecordedAct:
    """An external action started by the agent.

    Attributes:
        name: name of the action.
        arguments: plain values (numbers, strings, `jacaros.artifacts.env.values.Atom`, `Structure`, lists); None for an
            output.
        pending: whether the action has not ended yet.
        term: the action as a term.
        cancelled: whether its intention was dropped.
        paused: whether its intention is suspended.
    """

    def __init__(self, act: Act, complete: Complete) -> None:
        self._act = act
        self._complete = complete
        self.term: Term = (act.functor, *act.arguments) if act.arguments else act.functor
        self._outputs = free_variables(self.term)
        self.name = act.functor.name
        self.arguments = tuple(None if a.__class__ is Var else to_value(a) for a in act.arguments)
        self.pending = True
        self.cancelled = False
        self.paused = False

    def complete(self, *outputs: object) -> None:
        """Let the action succeed; *outputs* are the values of its unbound variables, in order.

        Raises:
            ValueError: the action has already ended, or the number of outputs differs from that of the unbound variables.
        """
        if outputs and len(outputs) != len(self._outputs):
            raise ValueError(f"{self} has {len(self._outputs)} unbound variables, not {len(outputs)}")
        values = [
            (variable, to_term(value, References()))
            for variable, value in zip(self._outputs, outputs, strict=False)
        ]
        self._end(Completion(True, tuple(values)))

    def fail(self, reason: str = "failed", message: str | None = None) -> None:
        """Let the action fail.

        Args:
            reason: reason term as text.
            message: message for the log (default: the reason).

        Raises:
            ValueError: the action has already ended.
        """
        self._end(failed(lower_value(parse_term(reason)), message))

    def _end(self, completion: Completion) -> None:
        if not self.pending:
            raise ValueError(f"{self} has already ended{' with its intention' if self.cancelled else ''}")
        self.pending = False
        self._complete(self._act.id, completion)

    def answer(self, function: Action) -> None:
        """Let a function answer the action: it receives the bound arguments and returns the outputs.

        It returns a single output as such, several as a tuple; without outputs, False makes the action fail.
        `AgentHarness.run` raises any exception other than `ActionFailed`.
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
        return text(self.term)

    def __repr__(self) -> str:
        return f"<act {self}{' pending' if self.pending else ''}>"


class SentMessage:
    """A message sent by the agent.

    Attributes:
        receiver: name of the receiving agent.
        performative: performative, such as ``tell``.
        content: content as text.
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
    """The fake actions of one agent, and all actions that it has started.

    Args:
        complete: reports the end of an action to the agent.
        later: calls a function after a number of seconds on the run's clock.

    Attributes:
        acts: every action started, fake or not, oldest first, with the outputs returned by a fake.
    """

    def __init__(self, complete: Complete, later: Later) -> None:
        self._complete = complete
        self._later = later
        self._fakes: list[_Fake] = []
        self.acts: list[Term] = []
        self._fakes_stop = False

    def add(self, pattern: Term, outcome: Term = None) -> None:
        """Answer actions that match *pattern*; the fake added last wins.

        Where the action has an unbound variable, the value in the pattern becomes its output.

        Args:
            pattern: an atom or structure; ``.stopMAS`` matches all its forms.
            outcome: ``done`` (the default), ``after(Ms)``, ``failed(Reason)``, ``failed(Reason, Message)`` or ``never``.

        Raises:
            ValueError: the outcome or the pattern is invalid.
        """
        outcome = atom("done") if outcome is None else resolve(outcome)
        if not _is_outcome(outcome):
            raise ValueError(
                f"invalid outcome {text(outcome)}: expected done, after(Ms), failed(Reason), failed(Reason, Message) or "
                "never"
            )
        symbol = functor_of(pattern)
        if symbol is None or (symbol.name[:1] == "." and symbol.name != STOP):
            raise ValueError(f"{text(pattern)} is not an external action")
        if symbol.name == STOP:
            self._fakes_stop = True
            return
        self._fakes.append(_Fake(rename(pattern), outcome))

    def begin(self, act: Act) -> bool:
        """Answer an action; return False if no fake matches."""
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
        """Record a call of ``.stopMAS``; return False if it is not faked and must end the run."""
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
    """Return the completion of a failed action, in the form that environments use."""
    message = String(text(reason)) if message is None else String(message)
    return Completion(False, (), ((ERROR_MSG, message), (REASON, reason)))


def _is_outcome(term: Term) -> bool:
    symbol = functor_of(term)
    if symbol is None:
        return False
    if (symbol.name, symbol.arity) == ("after", 1):
        return isinstance(term[1], float)
    if (symbol.name, symbol.arity) == ("failed", 2):
        return isinstance(term[2], str)
    return (symbol.name, symbol.arity) in {("done", 0), ("never", 0), ("failed", 1)}
