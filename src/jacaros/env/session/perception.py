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
    """Properties and signals of focused artifacts: the half of a `Session` that looks.

    Args:
        environment: what is perceived.
        name: who perceives.
        account: told what is waited for.
    """

    def __init__(self, environment: Environment, name: str, account: Account | None) -> None:
        self.environment = environment
        self.name = name
        self._account: Account = account if account is not None else NoAccount()
        self._observed = Observed(name, self._tell)
        # In the order of their making, so that a run is repeatable; who reads one keeps it alive.
        self._streams: list[ref[SignalStream]] = []
        self._conditions = Conditions()
        self._on_change: list[Callable[[PropertyChange], object]] = []
        self._on_signal: list[Callable[[ReceivedSignal], object]] = []
        self._closed = False

    @property
    def clock(self) -> Clock:
        """Where the environment takes time from."""
        return self.environment.clock

    @property
    def focused(self) -> tuple[ArtifactId, ...]:
        """The focused artifacts, in the order of focusing."""
        return self._observed.focused

    def lookup(self, name: str) -> ArtifactId:
        """Find an artifact by name or path."""
        raise NotImplementedError

    def value(
        self,
        name: str,
        index: int = 0,
        artifact: ArtifactId | str | None = None,
        default: Any = _REQUIRED,
    ) -> Any:
        """A value of the first property called *name* of the focused artifacts.

        Args:
            name: of the property; those of the artifact focused first come first, among them the oldest.
            index: which of its values.
            artifact: only of this one.
            default: given when there is no such property.

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
        """All values of the first property called *name* of the focused artifacts; see `value`.

        Raises:
            UnknownProperty: there is no such property.
        """
        found = next(self._find(name, (), artifact), None)
        if found is None:
            raise self._observed.unknown(name, self._narrowed(artifact))
        return found.values

    def has_property(self, name: str, *values: object, artifact: ArtifactId | str | None = None) -> bool:
        """True when a focused artifact has a property called *name*, with *values* (None for any) if given."""
        return next(self._find(name, values, artifact), None) is not None

    def properties(
        self, name: str, *values: object, artifact: ArtifactId | str | None = None
    ) -> tuple[ObservedProperty, ...]:
        """All properties called *name* of the focused artifacts, with *values* (None for any) if given."""
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
        """The signals of the focused artifacts from now on, to be read with ``async for``.

        None is lost between two turns of the loop.  It ends when it, or the session, is closed.

        Args:
            name: only signals of this name.
            artifact: only those of this one.
        """
        self._check()
        stream = SignalStream(name, self._narrowed(artifact), self._account.waiting)
        self._streams.append(ref(stream, self._streams.remove))
        return stream

    def on_change(self, callback: Callable[[PropertyChange], object]) -> Callable[[], None]:
        """Call *callback* with every change of a property of the focused artifacts; gives what ends that.

        The session shows all that was published together already.  It is called within the step of the
        artifact, so it should return soon.
        """
        return _enter(self._on_change, callback)

    def on_signal(self, callback: Callable[[ReceivedSignal], object]) -> Callable[[], None]:
        """Call *callback* with every signal of the focused artifacts; gives what ends that; see `on_change`."""
        return _enter(self._on_signal, callback)

    async def until(self, condition: Callable[[], T], timeout: float | None = None) -> T:
        """Wait until *condition* is true.

        It is evaluated now, and whenever a focused artifact has published something: also what is true for
        one step only is not missed.

        Args:
            condition: a function without arguments; what it raises is raised here.
            timeout: seconds to wait at most.

        Returns:
            The true value.

        Raises:
            TimeoutError: the time is over.
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
                self._call(on_signal, signal, "a callback for signals failed:")
        if self._on_change:
            for change in changes_of(observation):
                for on_change in tuple(self._on_change):
                    self._call(on_change, change, "a callback for changes failed:")
        self._conditions.evaluate()

    def _read_streams(self) -> list[SignalStream]:
        return [stream for each in self._streams if (stream := each()) is not None]

    def _call(self, callback: Callable[[T], object], told: T, what: str) -> None:
        try:
            callback(told)
        except Exception as error:
            self._complain(what, error)

    def _complain(self, what: str, error: Exception) -> None:
        """Tell people that the session's own code failed, where nobody else can be told."""
        self.environment.log_error(self.name, what, error)

    def _end_perceiving(self) -> None:
        self._on_change.clear()
        self._on_signal.clear()
        for stream in self._read_streams():
            stream.close()
        self._conditions.close(self._is_closed())
        for artifact in self.focused:
            self.environment.workspace(artifact.workspace).stop_focus(artifact, self._observed)
            self._observed.end(artifact)

    def _check(self) -> None:
        if self._closed:
            raise self._is_closed()

    def _is_closed(self) -> WorkspaceError:
        return WorkspaceError(f"session {self.name} has been closed")


def _enter(callbacks: list[T], callback: T) -> Callable[[], None]:
    callbacks.append(callback)
    return lambda: callbacks.remove(callback) if callback in callbacks else None
