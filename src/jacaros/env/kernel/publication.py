"""What observers see of one artifact: committed properties and signals."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.setting import Setting
from jacaros.env.observation import Observation, Observer, Signal, SlowObserver
from jacaros.env.property import ObservableProperty, PropertyChanges, PropertyStore
from jacaros.trace import Cause

_Telling = tuple[Iterator[Observer], str | None, Observation, Observation]
"""The observers to notify, the only addressee of the signals (None for all), its observation, and that of the others."""
_NOTHING: Any = None
_NOBODY: _Telling = iter(()), None, _NOTHING, _NOTHING


@dataclass(slots=True, eq=False, repr=False)
class Publication:
    """The observable side of one artifact.

    Attributes:
        artifact: the artifact.
        setting: what it shares with other artifacts.
        properties: the properties, including changes of the step in progress.
        observers: the observers that focus the artifact, in the order of focusing.
        coming: names of properties whose new values wait for the artifact's turn.
    """

    artifact: ArtifactId
    setting: Setting
    properties: PropertyStore = field(default_factory=PropertyStore, init=False)
    coming: set[str] = field(default_factory=set, init=False)
    _observers: dict[Observer, None] = field(default_factory=dict, init=False)
    _untaken: tuple[Callable[[str], bool], ...] = field(default=(), init=False)
    _frozen: tuple[ObservableProperty, ...] | None = field(default=None, init=False)
    _telling: _Telling = field(default=_NOBODY, init=False)

    @property
    def observers(self) -> tuple[Observer, ...]:
        """The observers that focus the artifact, in the order of focusing."""
        return tuple(self._observers)

    def committed(self) -> tuple[ObservableProperty, ...]:
        """Return the properties as observers know them."""
        return self._frozen if self._frozen is not None else self.properties.committed()

    def freeze(self) -> None:
        """Show observers the current state while a worker thread changes the properties."""
        self._frozen = self.properties.committed()

    def thaw(self) -> None:
        """End `freeze`: the worker thread has ended."""
        self._frozen = None

    def add(self, observer: Observer) -> None:
        """Add an observer. It receives what is published, beginning with all properties. Adding it again has no effect."""
        if observer not in self._observers:
            self._observers[observer] = None
            self._note_slow()
            self._tell_focus(observer, True)
            self._show(observer, added=self.committed())

    def remove(self, observer: Observer) -> None:
        """Remove an observer. The last observation removes all properties."""
        self._tell()
        if observer in self._observers:
            del self._observers[observer]
            self._note_slow()
            self._tell_focus(observer, False)
            self._show(observer, removed=self.committed())

    def _tell_focus(self, observer: Observer, on: bool) -> None:
        if self.setting.listener is not None:
            self.setting.listener.focused(self.artifact, observer.agent, on)

    def has_untaken(self, name: str) -> bool:
        """Return whether properties called *name* will change, or an observer has not processed an earlier change."""
        if name in self.coming:
            return True
        for is_untaken in self._untaken:  # noqa: SIM110 - called for every sensor message: a generator would be slower
            if is_untaken(name):
                return True
        return False

    def _note_slow(self) -> None:
        # Checking a protocol at run time costs more than a whole step, and sensors ask with every message.
        self._untaken = tuple(each.has_untaken for each in self._observers if isinstance(each, SlowObserver))

    def close(self) -> None:
        """Remove all observers."""
        for observer in self.observers:
            self.remove(observer)

    def _show(
        self,
        observer: Observer,
        added: tuple[ObservableProperty, ...] = (),
        removed: tuple[ObservableProperty, ...] = (),
    ) -> None:
        if added or removed:
            self._deliver(observer, Observation(self.artifact, (), (), added, removed))

    def publish(
        self, parent: Cause | None, signals: tuple[Signal, ...] = (), addressee: str | None = None
    ) -> None:
        """Commit the changes of the step so far, and publish them together with *signals*.

        Args:
            parent: what led to it.
            signals: signals to send.
            addressee: the only agent that receives the signals. None for all. All observers receive the changes.
        """
        changes = self.properties.commit()
        if not (signals or changes.changed or changes.added or changes.removed):
            return
        listener = self.setting.listener
        if not self._observers and self.setting.tracer is None and listener is None:
            return
        cause = parent if self.setting.tracer is None else self._trace(parent, signals, changes)
        complete = others = Observation(self.artifact, signals, *changes, cause)
        if addressee is not None:
            others = Observation(self.artifact, (), *changes, cause)
        if listener is not None:
            listener.published(complete)
        if self._telling is not _NOBODY:
            self._tell()
        self._telling = iter(tuple(self._observers)), addressee, complete, others
        self._tell()

    def _tell(self) -> None:
        """Notify the observers that have not been notified of the current publication.

        If an observer's reaction ends the focus of others, they are notified before that, so each observer sees
        everything in order.
        """
        untold, addressee, complete, others = self._telling
        if addressee is None:
            for observer in untold:
                try:
                    observer.observe(complete)
                except Exception as error:
                    self.setting.report(error)
        else:
            for observer in untold:
                if observer.agent == addressee:
                    self._deliver(observer, complete)
                elif others.changed or others.added or others.removed:
                    self._deliver(observer, others)
        self._telling = _NOBODY

    def _trace(
        self, parent: Cause | None, signals: tuple[Signal, ...], changes: PropertyChanges
    ) -> Cause | None:
        names = [signal.name for signal in signals] + [new.name for _, new in changes.changed]
        names += [each.name for each in (*changes.added, *changes.removed)]
        kind = "property" if changes.changed or changes.added or changes.removed else "signal"
        about = self.artifact, signals, changes
        return self.setting.trace(kind, f"{self.artifact.path} {' '.join(names)}", parent, about)

    def _deliver(self, observer: Observer, observation: Observation) -> None:
        try:
            observer.observe(observation)
        except Exception as error:
            self.setting.report(error)
