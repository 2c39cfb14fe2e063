"""Behaviours that use and observe artifacts, or wait on the run's clock."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Access, Status
from py_trees.decorators import Decorator

from jacaros.artifacts import Session
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownProperty
from jacaros.artifacts.env.values import equal, plain, text
from jacaros.artifacts.presence.presence import ReceivedSignal
from jacaros.runtime.clock import Clock
from jacaros.runtime.clock import Timer as ClockTimer


def nothing() -> None:
    """Do nothing: no runner waits for a tick."""


def session_of(behaviour: Behaviour, given: dict[str, Any]) -> Session:
    """Return the session that a behaviour is set up with.

    Raises:
        TypeError: none exists.
    """
    session = given.get("session")
    if not isinstance(session, Session):
        raise TypeError(
            f"behaviour `{behaviour.name}` has no session; tick its tree with a TreeRunner, or set the tree up "
            "with tree.setup(session=Session(environment, name))"
        )
    return session


class ArtifactBehaviour(Behaviour):
    """A behaviour that uses artifacts; behaviours of a project may derive from it, too.

    Attributes:
        session: access to the environment; set by `setup`.
        wake: requests a tick soon, because an awaited event has happened.
    """

    session: Session

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.wake: Callable[[], None] = nothing
        self.board = self.attach_blackboard_client()
        self._reported: str | None = None

    def setup(self, **given: Any) -> None:
        """Connect to the environment; called by `TreeRunner`, or with ``tree.setup(session=...)``.

        Args:
            given: ``session``, a `Session`; ``wake``, the function for `wake`, optional.

        Raises:
            TypeError: no session is given.
        """
        self.session = session_of(self, given)
        self.wake = given.get("wake", nothing)
        self._reported = None

    def let_go(self) -> None:
        """Cancel everything immediately: the tree ends, possibly after an exception."""

    @property
    def clock(self) -> Clock:
        """The clock of the behaviour."""
        return self.session.clock

    def may_read(self, key: str) -> None:
        """Register with the blackboard that this behaviour reads *key*, or an attribute of it."""
        self.board.register_key(key.partition(".")[0], Access.READ)

    def may_write(self, key: str) -> None:
        """Register with the blackboard that this behaviour writes *key*."""
        self.board.register_key(key, Access.WRITE)

    def complain(self, what: str, error: Exception) -> None:
        """Show in ``feedback_message`` that the author's own code raised an exception, and log it, but not at every
        tick."""
        self.feedback_message = f"{what} raised {type(error).__name__}: {error}"
        if self._is_news(self.feedback_message):
            where = f"behaviour '{self.name}': {what} failed:"
            self.session.environment.log_error(self.session.name, where, error)

    def warn(self, text: str) -> None:
        """Log a mistake in the tree, but not at every tick."""
        if self._is_news(text):
            self.session.environment.log(f"[{self.session.name}] behaviour '{self.name}': {text}")

    def _is_news(self, text: str) -> bool:
        told, self._reported = self._reported, text
        return told != text


def _call(name: str, values: Sequence[object]) -> str:
    return f"{name}({', '.join(text(value, True) for value in values)})" if values else name


class PropertyCheck(ArtifactBehaviour):
    """SUCCESS if a property has matching values, otherwise FAILURE; of several with one name, one is enough.

    Args:
        property_name: its name.
        predicate: called with the values of the property, such as ``lambda level: level > 20``; default: any values
            match. If it raises an exception, the behaviour fails.
        artifact: the artifact with the property; default: any focused one.
        name: name of the behaviour; default: the property's name with a question mark.
    """

    otherwise = Status.FAILURE

    def __init__(
        self,
        property_name: str,
        predicate: Callable[..., object] | None = None,
        *,
        artifact: ArtifactId | str | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(name or f"{property_name}?")
        self.property_name, self.predicate, self.artifact = property_name, predicate, artifact

    def update(self) -> Status:
        """Check the property."""
        try:
            seen = self.session.properties(self.property_name, artifact=self.artifact)
            if not seen:
                self.session.value(self.property_name, artifact=self.artifact)
        except (OperationFailed, UnknownProperty) as unknown:
            self.feedback_message = str(unknown)
            return self.otherwise
        self.feedback_message = ", ".join(_call(each.name, each.values) for each in seen)
        try:
            fits = any(self.predicate is None or self.predicate(*each.values) for each in seen)
        except Exception as error:
            self.complain("the predicate", error)
            return Status.FAILURE
        return Status.SUCCESS if fits else self.otherwise


class WaitForProperty(PropertyCheck):
    """As `PropertyCheck`, but RUNNING until the values match."""

    otherwise = Status.RUNNING


class HasProperty(PropertyCheck):
    """SUCCESS if a property has these values, otherwise FAILURE.

    Args:
        property_name: its name.
        values: all its values; default: any.
        artifact: the artifact with the property; default: any focused one.
        name: name of the behaviour; default: such as ``holder(driver)?``.
    """

    def __init__(
        self,
        property_name: str,
        *values: object,
        artifact: ArtifactId | str | None = None,
        name: str | None = None,
    ) -> None:
        wanted = [plain(value) for value in values]
        predicate = (lambda *found: equal(list(found), wanted)) if wanted else None
        shown = f"{property_name}({', '.join(map(text, wanted))})" if wanted else property_name
        super().__init__(property_name, predicate, artifact=artifact, name=name or f"{shown}?")


class PropertiesToBlackboard(ArtifactBehaviour):
    """Copy properties to the blackboard at every tick; always SUCCESS.

    A property with one value yields that value, any other a tuple; of several with one name, the first counts. The
    key of a missing property is removed. As with topics, place it first below a ``Parallel``.

    Args:
        properties: names of properties, which are also the keys; or a dictionary from names to keys.
        artifact: the artifact with the properties; default: any focused one.
        name: name of the behaviour.
    """

    def __init__(
        self,
        properties: str | Sequence[str] | Mapping[str, str],
        *,
        artifact: ArtifactId | str | None = None,
        name: str = "properties to blackboard",
    ) -> None:
        super().__init__(name)
        names = [properties] if isinstance(properties, str) else properties
        self.keys = dict(names) if isinstance(names, Mapping) else {each: each for each in names}
        self.artifact = artifact
        for key in self.keys.values():
            self.may_write(key)

    def update(self) -> Status:
        """Copy the properties."""
        missing = [name for name, key in self.keys.items() if not self._copy(name, key)]
        self.feedback_message = f"no focused artifact has {', '.join(missing)}" if missing else ""
        return Status.SUCCESS

    def _copy(self, name: str, key: str) -> bool:
        try:
            values = self.session.properties(name, artifact=self.artifact)[0].values
        except (OperationFailed, IndexError):
            self.board.unset(key)
            return False
        self.board.set(key, values[0] if len(values) == 1 else values)
        return True


class OnSignal(ArtifactBehaviour):
    """SUCCESS if the signal arrived since the last tick, otherwise FAILURE.

    It receives signals from `setup` on, ticked or not, so a signal between two ticks is not missed. Several signals
    between two ticks are one SUCCESS, with the arguments of the latest.

    Args:
        signal: name of the signal.
        predicate: called with its arguments; other signals are skipped. If it raises an exception, the behaviour
            fails.
        artifact: name of the artifact; default: any focused one.
        to: blackboard key for the arguments, a tuple.
        name: name of the behaviour; default: the signal's name with an exclamation mark.
    """

    otherwise = Status.FAILURE

    def __init__(
        self,
        signal: str,
        predicate: Callable[..., object] | None = None,
        *,
        artifact: str | None = None,
        to: str | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(name or f"{signal}!")
        self.signal, self.predicate, self.artifact, self.to = signal, predicate, artifact, to
        self._heard: tuple[object, ...] | None = None
        self._wrong: Exception | None = None
        self._stop_hearing: Callable[[], object] = nothing
        if to is not None:
            self.may_write(to)

    def setup(self, **given: Any) -> None:
        """Start receiving; see `ArtifactBehaviour.setup`."""
        super().setup(**given)
        self.shutdown()
        self._heard = self._wrong = None
        self._stop_hearing = self.session.on_signal(self._hear)

    def shutdown(self) -> None:
        """Stop receiving."""
        self._stop_hearing()
        self._stop_hearing = nothing

    def update(self) -> Status:
        """Return whether the signal arrived."""
        heard, wrong = self._heard, self._wrong
        self._heard = self._wrong = None
        if wrong is not None:
            self.complain("the predicate", wrong)
            return Status.FAILURE
        if heard is None:
            self.feedback_message = f"no {self.signal}"
            return self.otherwise
        self.feedback_message = _call(self.signal, heard)
        if self.to is not None:
            self.board.set(self.to, heard)
        return Status.SUCCESS

    def _hear(self, signal: ReceivedSignal) -> None:
        if signal.name != self.signal or self.artifact not in (None, signal.artifact.name):
            return
        try:
            if self.predicate is not None and not self.predicate(*signal.arguments):
                return
            self._heard = signal.arguments
        except Exception as error:
            self._wrong = error
        self.wake()


class WaitForSignal(OnSignal):
    """RUNNING until the signal arrives, then SUCCESS; signals from before the first tick do not count.

    The arguments are those of `OnSignal`.
    """

    otherwise = Status.RUNNING

    def initialise(self) -> None:
        """Forget earlier signals."""
        self._heard = self._wrong = None


class _Countdown:
    """Time that runs out.

    Attributes:
        over: whether it has run out.
    """

    def __init__(self) -> None:
        self.over = False
        self._timer: ClockTimer | None = None

    def start(self, clock: Clock, seconds: float, wake: Callable[[], None]) -> None:
        """Begin anew; *wake* is called at the end."""

        def ring() -> None:
            self.over = True
            wake()

        self.over = False
        self._timer = clock.call_later(seconds, ring)

    def stop(self) -> None:
        """Let the time not run out."""
        if self._timer is not None:
            self._timer.cancel()


class Timer(ArtifactBehaviour):
    """RUNNING for some time, then SUCCESS.

    Args:
        duration: seconds of the run's clock.
        name: name of the behaviour.
    """

    def __init__(self, duration: float, name: str | None = None) -> None:
        super().__init__(name or f"{duration:g} s")
        self.duration = duration
        self._time = _Countdown()

    def initialise(self) -> None:
        """Start waiting."""
        self._time.start(self.session.clock, self.duration, self.wake)

    def update(self) -> Status:
        """Check whether the time is over."""
        self.feedback_message = "over" if self._time.over else f"waiting {self.duration:g} s"
        return Status.SUCCESS if self._time.over else Status.RUNNING

    def terminate(self, new_status: Status) -> None:
        """Stop waiting."""
        self._time.stop()

    def let_go(self) -> None:
        """Stop waiting."""
        self._time.stop()


class Timeout(Decorator):
    """Interrupt the child if it takes too long, and fail.

    Args:
        child: the child.
        duration: maximum time in seconds of the run's clock.
        name: name of the behaviour.
    """

    def __init__(self, child: Behaviour, duration: float, name: str | None = None) -> None:
        super().__init__(name or f"at most {duration:g} s", child)
        self.duration = duration
        self.wake: Callable[[], None] = nothing
        self._clock: Clock
        self._time = _Countdown()

    def setup(self, **given: Any) -> None:
        """Store the clock; see `ArtifactBehaviour.setup`."""
        self._clock = session_of(self, given).clock
        self.wake = given.get("wake", nothing)

    def initialise(self) -> None:
        """Start the time-out."""
        self._time.start(self._clock, self.duration, self.wake)

    def update(self) -> Status:
        """Return the child's status while there is time."""
        late = self._time.over and self.decorated.status is Status.RUNNING
        self.feedback_message = f"took longer than {self.duration:g} s" if late else ""
        return Status.FAILURE if late else self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Stop the time-out."""
        self._time.stop()
