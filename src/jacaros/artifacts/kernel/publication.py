"""What observers see of one artifact: committed properties and signals."""

import ast
import asyncio
import inspect
import sys
import textwrap
import threading
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Final

from jacaros.artifacts.env.arbiter import Arbiter
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.execution import EnvironmentListener
from jacaros.artifacts.env.property import (
    ObservableProperty,
    Observation,
    Observer,
    PropertyChanges,
    PropertyStore,
    Signal,
    SlowObserver,
)
from jacaros.runtime.clock import Clock
from jacaros.runtime.errors import InternalError
from jacaros.runtime.trace import Cause, Tracer

# Statements without effect: ``self.value("path").append(x)`` changes a copy, ``self.sleep(1)`` lacks its ``await``.


_CHANGING: Final = frozenset(
    {
        *("append", "extend", "insert", "remove", "pop", "clear", "sort", "reverse"),
        *("update", "setdefault", "popitem"),
    }
)
"""Mutating methods of lists and dictionaries."""


def mistakes_in(artifact_type: type) -> Iterator[str]:
    """Return the statements without effect in the methods of a user-defined class: place, call, and how to fix it."""
    if artifact_type.__module__.startswith("jacaros."):
        return
    for member in vars(artifact_type).values():
        code = getattr(member, "__code__", None)
        # Only methods that use such names have their source read.
        if code is not None and any(
            name in _CHANGING or _is_coroutine(artifact_type, name) for name in code.co_names
        ):
            yield from _in_method(artifact_type, member)


def _in_method(artifact_type: type, function: Callable[..., Any]) -> Iterator[str]:
    try:
        lines, first = inspect.getsourcelines(function)
        tree = ast.parse(textwrap.dedent("".join(lines)))
    except (OSError, SyntaxError, TypeError):  # created at run time, or its file is gone
        return
    for node in ast.walk(tree):
        # `last = self.value("path").pop()` uses the copy; a statement does not.
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            wrong = _without_effect(artifact_type, node.value.func)
            if wrong is not None:
                place = f"{function.__qualname__} (line {first + node.lineno - 1})"
                yield f"in {place}: {ast.unparse(node.value)} {wrong}"


def _without_effect(artifact_type: type, method: ast.expr) -> str | None:
    match method:
        case ast.Attribute(ast.Name("self"), name) if _is_coroutine(artifact_type, name):
            return f"has no effect without await: write `await self.{name}(...)` in an async def"
        case ast.Attribute(ast.Call(ast.Attribute(ast.Name("self"), "value")), name) if name in _CHANGING:
            return (
                "changes only a copy of the value: keep it in a variable, change the variable, and pass it to "
                "self.update_property"
            )
    return None


def _is_coroutine(artifact_type: type, name: str) -> bool:
    return inspect.iscoroutinefunction(getattr(artifact_type, name, None))


# What all artifacts of an environment share: clock, log, and the handling of internal errors.


def log_to_stderr(text: str) -> None:
    """Write *text* as a line to standard error."""
    print(text, file=sys.stderr)


@dataclass(slots=True, eq=False, repr=False)
class Setting:
    """What the artifacts of one environment share.

    Attributes:
        clock: clock of the run.
        resources: services of the host for artifacts, such as ``ros`` and ``console``, by name.
        log: takes a line of the log, such as ``[lamp] on``.
        tracer: receives every cause. None if no tracer is set.
        listener: receives what happens in the artifacts. None if no listener is set.
        told: advice to authors that has been logged once.
        arbiter: assigns resources to operations and plans.
        loop: event loop of the operations. None before the first one.
        thread: the thread of the loop; 0 before the first operation.
        on_internal_error: called with defects of JaCaROS itself. None lets them propagate.
    """

    clock: Clock
    resources: Mapping[str, object] = field(default_factory=dict)
    log: Callable[[str], None] = log_to_stderr
    tracer: Tracer | None = None
    on_internal_error: Callable[[BaseException], None] | None = None
    listener: EnvironmentListener | None = None
    told: set[object] = field(default_factory=set, init=False)
    arbiter: Arbiter = field(init=False)
    loop: asyncio.AbstractEventLoop | None = field(default=None, init=False)
    thread: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self.arbiter = Arbiter(self.clock, lambda text: self.log(f"warning: {text}"))

    def know_loop(self) -> None:
        """Remember the running event loop as that of the operations."""
        if self.loop is None:
            with suppress(RuntimeError):
                self.loop = asyncio.get_running_loop()
                self.thread = threading.get_ident()

    def elsewhere(self) -> bool:
        """Return whether the caller is in another thread than that of the event loop."""
        return self.thread != 0 and self.thread != threading.get_ident()

    def call_on_loop(self, callback: Callable[[], object]) -> None:
        """Call *callback* on the event loop, from another thread. No effect if the loop has ended."""
        if self.loop is not None:
            with suppress(RuntimeError):
                self.loop.call_soon_threadsafe(callback)

    def log_error(self, who: str, what: str, error: BaseException) -> None:
        """Log that *what* failed in *who*, with the traceback of *error* below the kernel."""
        self.log(f"[{who}] {what}")
        frames = error.__traceback__.tb_next if error.__traceback__ is not None else None
        for line in "".join(traceback.format_exception(type(error), error, frames)).splitlines():
            self.log(f"[{who}]   {line}")

    def report(self, error: BaseException) -> None:
        """Report a defect of JaCaROS itself.

        Raises:
            InternalError: `on_internal_error` is not set.
        """
        if self.on_internal_error is not None:
            self.on_internal_error(error)
        elif isinstance(error, InternalError):
            raise error
        else:
            raise InternalError(f"{type(error).__name__}: {error}") from error

    def trace(self, kind: str, what: str, parent: Cause | None, about: object = None) -> Cause | None:
        """Return the next cause after *parent*; *parent* itself if no tracer is set."""
        return parent if self.tracer is None else self.tracer.link(kind, what, parent, about)


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
    _telling: _Telling = field(default=_NOBODY, init=False)

    @property
    def observers(self) -> tuple[Observer, ...]:
        """The observers that focus the artifact, in the order of focusing."""
        return tuple(each for each in self._observers if each.agent)

    def committed(self) -> tuple[ObservableProperty, ...]:
        """Return the properties as observers know them."""
        return self.properties.committed()

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

    def follow(self, observer: Observer, on: bool = True) -> None:
        """Let *observer*, which does not belong to an agent, receive what is published from now on, or no longer."""
        if on:
            self._observers[observer] = None
        else:
            self._observers.pop(observer, None)

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
