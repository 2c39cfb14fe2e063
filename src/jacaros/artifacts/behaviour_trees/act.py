"""``Act``: an operation of an artifact as a behaviour, with arguments and results on the blackboard."""

from dataclasses import dataclass

from py_trees.common import Status

from jacaros.artifacts.behaviour_trees.behaviours import ArtifactBehaviour
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.values import Atom, Out, Structure, text
from jacaros.artifacts.presence.session import SessionOperation

MISTAKES = ("unknown_operation", "wrong_op_arguments")
"""Functors of reasons that indicate a mistake in the tree, not in the world; these are logged, too."""

FAILURE = "failure"
"""Blackboard key of the last failure."""


@dataclass(frozen=True, slots=True)
class Failure:
    """The value that `Act` writes to the blackboard when its operation fails.

    Attributes:
        behaviour: name of the behaviour.
        message: text of the failure.
        reason: term for programs, such as ``aborted(0.42)``; None if the operation has none.
    """

    behaviour: str
    message: str
    reason: Structure | Atom | None


class Act(ArtifactBehaviour):
    """Run an operation: RUNNING while it runs, then SUCCESS or FAILURE.

    If the tree interrupts it, the operation is cancelled: a motion stops the robot. Ticked again, it starts again. If
    it fails, ``feedback_message`` gives the reason, and a `Failure` is written to the blackboard.

    Args:
        operation: its name, as in agent programs.
        arguments: values; `FromBlackboard` for values known at run time, `ToBlackboard` for output parameters.
        artifact: the artifact that runs it; default: the one that `Session.act` chooses.
        timeout: maximum time in seconds of the run's clock.
        urgency: precedence for the resources that it uses; higher first.
        name: name of the behaviour; default: the call, such as ``moveForward(1)``.

    Attributes:
        outcome: outcome of the operation, None while it runs.
    """

    def __init__(
        self,
        operation: str,
        *arguments: object,
        artifact: ArtifactId | str | None = None,
        timeout: float | None = None,
        urgency: int = 0,
        name: str | None = None,
    ) -> None:
        super().__init__(name or _written(operation, arguments))
        self.operation, self.arguments = operation, arguments
        self.artifact, self.timeout, self.urgency = artifact, timeout, urgency
        self.outcome: OperationOutcome | None = None
        self._handle: SessionOperation | None = None
        self._results: dict[str, Out] = {}
        for argument in arguments:
            if isinstance(argument, FromBlackboard):
                self.may_read(argument.key)
            elif isinstance(argument, ToBlackboard):
                self.may_write(argument.key)
        self.may_write(FAILURE)

    def initialise(self) -> None:
        """Start the operation."""
        self._handle, self.outcome, self._results = None, None, {}
        try:
            arguments = [self._value(argument) for argument in self.arguments]
        except OperationFailed as failure:
            self.outcome = OperationOutcome.of(failure)
            return
        self._handle = self.session.begin(
            self.operation, *arguments, artifact=self.artifact, timeout=self.timeout, urgency=self.urgency
        )
        self._handle.on_end(self._ended)

    def update(self) -> Status:
        """Check whether the operation has ended."""
        if self._handle is not None:
            self.outcome = self._handle.outcome
        if self.outcome is None:
            self.feedback_message = "running"
            return Status.RUNNING
        return self._succeed() if self.outcome.ok else self._fail(self.outcome)

    def terminate(self, new_status: Status) -> None:
        """Cancel the operation if it is still running."""
        if self._handle is not None and not self._handle.done:
            self.feedback_message = "cancelled"
        self.let_go()

    def let_go(self) -> None:
        """Cancel the operation if it is still running."""
        handle, self._handle = self._handle, None
        if handle is not None:
            handle.cancel()

    def _ended(self, handle: SessionOperation) -> None:
        if handle is self._handle:
            self.wake()

    def _value(self, argument: object) -> object:
        if isinstance(argument, FromBlackboard):
            try:
                return self.board.get(argument.key)
            except KeyError:
                raise OperationFailed(
                    f"the blackboard has no key `{argument.key}`",
                    Structure("not_on_blackboard", (argument.key,)),
                ) from None
        if isinstance(argument, ToBlackboard):
            return self._results.setdefault(argument.key, Out())
        return argument

    def _succeed(self) -> Status:
        given = {key: out.value for key, out in self._results.items() if out.is_set}
        for key, value in given.items():
            self.board.set(key, value)
        self.feedback_message = ", ".join(f"{key} = {text(value, True)}" for key, value in given.items())
        return Status.SUCCESS

    def _fail(self, outcome: OperationOutcome) -> Status:
        message = outcome.message or f"{self.operation} failed"
        reason = outcome.reason
        self.feedback_message = message if reason is None else f"{message} [{text(reason, True)}]"
        self.board.set(FAILURE, Failure(self.name, message, reason))
        if isinstance(reason, Structure) and reason.functor in MISTAKES:
            self.warn(message)
        return Status.FAILURE


def _written(operation: str, arguments: tuple[object, ...]) -> str:
    from_tree = FromBlackboard, ToBlackboard
    shown = [str(each) if isinstance(each, from_tree) else text(each, True) for each in arguments]
    return f"{operation}({', '.join(shown)})" if shown else operation


@dataclass(frozen=True, slots=True)
class FromBlackboard:
    """An argument that is read from the blackboard whenever the operation starts.

    Attributes:
        key: blackboard key, such as ``goal``, or an attribute of its value, such as ``goal.x``.
    """

    key: str

    def __str__(self) -> str:
        return self.key


@dataclass(frozen=True, slots=True)
class ToBlackboard:
    """An output parameter: its value is written to the blackboard when the operation has succeeded.

    Attributes:
        key: blackboard key.
    """

    key: str

    def __str__(self) -> str:
        return f"-> {self.key}"
