"""What a test sees of an agent: the actions it has begun, the messages it has sent, the goals it was given."""

from collections.abc import Callable

from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import lower_value
from jacaros.bdi.state.act import Act, Completion
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import References, to_term, to_value
from jacaros.terms.substitution import free_variables
from jacaros.terms.text import text
from jacaros.terms.values import Term, Var
from jacaros.testing.fakes import failed

Action = Callable[..., object]
"""Answers an external action, see `RecordedAct.answer`."""


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

    def __init__(self, act: Act, complete: Callable[[int, Completion], None]) -> None:
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
