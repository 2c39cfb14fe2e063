"""``Act``: an operation of an artifact as a behaviour, with arguments from the blackboard and results that go there."""

from dataclasses import dataclass

from py_trees.common import Status

from jacaros.behaviour_trees.artifact_behaviour import ArtifactBehaviour
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId
from jacaros.env.operation import OperationOutcome
from jacaros.env.session.operation import SessionOperation
from jacaros.env.values import Atom, Out, Structure, text

MISTAKES = ("unknown_operation", "wrong_op_arguments")
"""Functors of reasons that tell of a mistake in the tree and not of the world: people are told, too."""


@dataclass(frozen=True, slots=True)
class Failure:
    """What `Act` leaves on the blackboard when its operation fails.

    Attributes:
        behaviour: name of the behaviour.
        message: text for people.
        reason: term for programs, such as ``aborted(0.42)``; None when the operation gave none.
    """

    behaviour: str
    message: str
    reason: Structure | Atom | None


class Act(ArtifactBehaviour):
    """Do an operation: RUNNING while it is under way, then SUCCESS or FAILURE.

    Interrupted by the tree, the operation is cancelled: a motion stops the robot.  Ticked again, it begins anew.  When it
    fails, ``feedback_message`` tells why, and a `Failure` goes to the blackboard.

    Args:
        operation: its name, as agents call it.
        arguments: values; `FromBlackboard` for what is known only later, `ToBlackboard` for output parameters.
        artifact: which one is to do it; without it the one that `Session.act` chooses.
        timeout: seconds of the run's clock that it may take.
        urgency: decides who gets the resources that it uses; the greater one first.
        failure_key: where the `Failure` goes, None for nowhere.
        name: of the behaviour; the call, such as ``moveForward(1)``, unless given.

    Attributes:
        outcome: how the operation ended, None while it is under way.
    """

    def __init__(
        self,
        operation: str,
        *arguments: object,
        artifact: ArtifactId | str | None = None,
        timeout: float | None = None,
        urgency: int = 0,
        failure_key: str | None = "failure",
        name: str | None = None,
    ) -> None:
        super().__init__(name or _written(operation, arguments))
        self.operation, self.arguments = operation, arguments
        self.artifact, self.timeout, self.urgency = artifact, timeout, urgency
        self.failure_key = failure_key
        self.outcome: OperationOutcome | None = None
        self._handle: SessionOperation | None = None
        self._results: dict[str, Out] = {}
        for argument in arguments:
            if isinstance(argument, FromBlackboard):
                self.may_read(argument.key)
            elif isinstance(argument, ToBlackboard):
                self.may_write(argument.key)
        if failure_key is not None:
            self.may_write(failure_key)

    def initialise(self) -> None:
        """Begin the operation."""
        self._handle, self.outcome, self._results = None, None, {}
        try:
            arguments = [self._value(argument) for argument in self.arguments]
        except OperationFailed as failure:
            self.outcome = OperationOutcome(False, failure.message, failure.reason)
            return
        self._handle = self.session.begin(
            self.operation, *arguments, artifact=self.artifact, timeout=self.timeout, urgency=self.urgency
        )
        self._handle.on_end(self._ended)

    def update(self) -> Status:
        """Look whether the operation has ended."""
        if self._handle is not None:
            self.outcome = self._handle.outcome
        if self.outcome is None:
            self.feedback_message = "under way"
            return Status.RUNNING
        return self._succeed() if self.outcome.ok else self._fail(self.outcome)

    def terminate(self, new_status: Status) -> None:
        """Cancel the operation if it is still under way."""
        if self._handle is not None and not self._handle.done:
            self.feedback_message = "cancelled"
        self.let_go()

    def let_go(self) -> None:
        """Cancel the operation if it is still under way."""
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
                    f"there is no {argument.key} on the blackboard",
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
        if self.failure_key is not None:
            self.board.set(self.failure_key, Failure(self.name, message, reason))
        if isinstance(reason, Structure) and reason.functor in MISTAKES:
            self.warn(message)
        return Status.FAILURE


def _written(operation: str, arguments: tuple[object, ...]) -> str:
    """A call as people write it."""
    from_tree = FromBlackboard, ToBlackboard
    shown = [str(each) if isinstance(each, from_tree) else text(each, True) for each in arguments]
    return f"{operation}({', '.join(shown)})" if shown else operation


@dataclass(frozen=True, slots=True)
class FromBlackboard:
    """An argument that is read from the blackboard whenever the operation begins.

    Attributes:
        key: of the blackboard, such as ``goal``, or an attribute of what is there, such as ``goal.x``.
    """

    key: str

    def __str__(self) -> str:
        return self.key


@dataclass(frozen=True, slots=True)
class ToBlackboard:
    """An output parameter: its value goes to the blackboard when the operation has succeeded.

    Attributes:
        key: of the blackboard.
    """

    key: str

    def __str__(self) -> str:
        return f"-> {self.key}"
