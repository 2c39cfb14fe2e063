"""What a session perceives of the artifacts that it focuses."""

from collections.abc import Callable, Iterator
from typing import Any, TypeVar
from weakref import ref

from jacaros.clock import Clock
from jacaros.env.environment import Environment
from jacaros.env.errors import WorkspaceError
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation
from jacaros.env.session.account import Account, NoAccount
from jacaros.env.session.condition import Conditions
from jacaros.env.session.observed import Observed, ObservedProperty, PropertyChange, changes_of
from jacaros.env.session.signal_stream import ReceivedSignal, SignalStream
from jacaros.env.values import plain

T = TypeVar("T")
_REQUIRED: Any = object()


class Perceiving:
    """Properties and signals of focused artifacts: the observing half of a `Session`.

    Args:
        environment: the environment.
        name: name of the session.
        account: counts waits.
    """

    def __init__(self, environment: Environment, name: str, account: Account | None) -> None:
        self.environment = environment
        self.name = name
        self._account: Account = account if account is not None else NoAccount()
        self._observed = Observed(name, self._tell)
        # In the order of creation, so that a run is reproducible. A stream lives as long as its reader.
        self._streams: list[ref[SignalStream]] = []
        self._conditions = Conditions()
        self._on_change: list[Callable[[PropertyChange], object]] = []
        self._on_signal: list[Callable[[ReceivedSignal], object]] = []
        self._closed = False

    @property
    def clock(self) -> Clock:
        """The clock of the environment."""
        return self.environment.clock

    @property
    def focused(self) -> tuple[ArtifactId, ...]:
        """The focused artifacts, in the order of focusing."""
        return self._observed.in_order()

    def lookup(self, name: str) -> ArtifactId:
        """Return an artifact by name or path."""
        raise NotImplementedError

    def value(
        self,
        name: str,
        index: int = 0,
        artifact: ArtifactId | str | None = None,
        default: Any = _REQUIRED,
    ) -> Any:
        """Return a value of the first property called *name* of the focused artifacts.

        Args:
            name: name of the property. Those of the artifact focused first come first, among them the oldest.
            index: index of the value, from 0.
            artifact: only properties of this artifact.
            default: returned if there is no such property.

        Raises:
            UnknownProperty: there is no such property, and no default.
        """
        found = next(self._find(name, (), artifact), None)
        if found is None:
            if default is not _REQUIRED:
                return default
            raise self._observed.unknown(name, self._narrowed(artifact))
        return found.values[index]

    def values(self, name: str, artifact: ArtifactId | str | None = None) -> tuple[Any, ...]:
        """Return all values of the first property called *name* of the focused artifacts. See `value`.

        Raises:
            UnknownProperty: there is no such property.
        """
        found = next(self._find(name, (), artifact), None)
        if found is None:
            raise self._observed.unknown(name, self._narrowed(artifact))
        return found.values

    def has_property(self, name: str, *values: object, artifact: ArtifactId | str | None = None) -> bool:
        """Return whether a focused artifact has a property called *name*, with *values* (None for any) if given."""
        return next(self._find(name, values, artifact), None) is not None

    def properties(
        self, name: str, *values: object, artifact: ArtifactId | str | None = None
    ) -> tuple[ObservedProperty, ...]:
        """Return all properties called *name* of the focused artifacts, with *values* (None for any) if given."""
        return tuple(self._find(name, values, artifact))

    def _find(
        self, name: str, values: tuple[object, ...], artifact: ArtifactId | str | None
    ) -> Iterator[ObservedProperty]:
        return self._observed.find(name, values, self._narrowed(artifact))

    def _narrowed(self, artifact: ArtifactId | str | None) -> ArtifactId | None:
        if isinstance(artifact, str):
            named = (each for each in self.focused if artifact in (each.name, each.path))
            return next(named, None) or self.lookup(artifact)
        return artifact

    def signals(self, name: str | None = None, artifact: ArtifactId | str | None = None) -> SignalStream:
        """Return a stream of the signals of the focused artifacts from now on, for ``async for``.

        No signal is lost between two turns of the event loop. The stream ends when it, or the session, is closed.

        Args:
            name: only signals of this name.
            artifact: only signals of this artifact.
        """
        self._check()
        stream = SignalStream(name, self._narrowed(artifact), self._account.waiting)
        self._streams.append(ref(stream, self._streams.remove))
        return stream

    def on_change(self, callback: Callable[[PropertyChange], object]) -> Callable[[], None]:
        """Call *callback* with every change of a property of the focused artifacts. Return a function that ends this.

        By then, the session shows everything that was published together. The callback runs within the step of the
        artifact, so it should return soon.
        """
        return _enter(self._on_change, callback)

    def on_signal(self, callback: Callable[[ReceivedSignal], object]) -> Callable[[], None]:
        """Call *callback* with every signal of the focused artifacts. Return a function that ends this. See `on_change`."""
        return _enter(self._on_signal, callback)

    async def until(self, condition: Callable[[], T], timeout: float | None = None) -> T:
        """Wait until *condition* is true.

        It is evaluated now, and whenever a focused artifact publishes something, so a condition that holds for only one
        step is not missed.

        Args:
            condition: a function without arguments. An exception in it is raised here.
            timeout: time limit in seconds.

        Returns:
            The value of the condition.

        Raises:
            TimeoutError: the time limit has passed.
            WorkspaceError: the session was closed.
        """
        self._check()
        value = condition()
        if value:
            return value
        if timeout is None:
            with self._account.waiting():
                return await self._conditions.wait(condition)
        self._account.begin()
        try:
            return await self._conditions.wait(condition, self.clock, timeout)
        finally:
            self._account.end()

    def _tell(self, observation: Observation) -> None:
        for name, arguments in observation.signals:
            signal = ReceivedSignal(name, tuple(map(plain, arguments)), observation.artifact)
            for stream in self._read_streams():
                stream.put(signal)
            for on_signal in tuple(self._on_signal):
                self._call(on_signal, signal, "an on_signal callback raised:")
        if self._on_change:
            for change in changes_of(observation):
                for on_change in tuple(self._on_change):
                    self._call(on_change, change, "an on_change callback raised:")
        self._conditions.evaluate()

    def _read_streams(self) -> list[SignalStream]:
        return [stream for each in self._streams if (stream := each()) is not None]

    def _call(self, callback: Callable[[T], object], told: T, what: str) -> None:
        try:
            callback(told)
        except Exception as error:
            self._complain(what, error)

    def _complain(self, what: str, error: Exception) -> None:
        """Log that the session's own code failed, where no caller can receive the exception."""
        self.environment.log_error(self.name, what, error)

    def _end_perceiving(self) -> None:
        self._on_change.clear()
        self._on_signal.clear()
        for stream in self._read_streams():
            stream.close()
        self._conditions.close(self._is_closed())

    def _check(self) -> None:
        if self._closed:
            raise self._is_closed()

    def _is_closed(self) -> WorkspaceError:
        return WorkspaceError(f"session {self.name} has been closed")


def _enter(callbacks: list[T], callback: T) -> Callable[[], None]:
    callbacks.append(callback)
    return lambda: callbacks.remove(callback) if callback in callbacks else None
