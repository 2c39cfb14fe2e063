"""Records of causes: those that led to something, of all that arise."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from jacaros.clock import Clock
from jacaros.mas.history.values import call_text, limited, message_text, request_text
from jacaros.trace import Cause, Tracer

KEPT = 10_000
"""Causes that are remembered at most until something needs them; most sensor messages lead to nothing."""
COMMAND_PERIOD = 0.5
"""Seconds between two records of commands that one operation sends to one topic; the last one is recorded, too."""
RECORDED = ("event", "message")
"""Links that have records of their own, deliberations and messages; what led to them is recorded with these."""
LARGE = 4096
"""Elements of the field ``data`` from which on a message, such as an image, is not remembered."""

Tell = Callable[[str, Mapping[str, Any]], None]


class Link(NamedTuple):
    """A cause that arose at *at* (seconds of the clock), and what it is about."""

    cause: Cause
    at: float
    about: Any


class CauseRecords:
    """Numbers the causes of a run, and records chains: each link once, as soon as something needs it.

    What needs a chain is an act, a command, and whatever calls `need`.  See ``docs/reference/recordings.md`` for the
    fields of the record ``cause``.

    Args:
        clock: of the run.
        beginning: seconds of the clock from which ``at`` counts.
        tell: takes the kind of a record and its data.
        passed: takes each message of our node: ``in`` or ``out``, its topic, the message.
    """

    def __init__(
        self,
        clock: Clock,
        beginning: float,
        tell: Tell,
        passed: Callable[[str, str, Any], None] = lambda direction, topic, message: None,
    ) -> None:
        self._clock, self._beginning, self._tell, self._passed = clock, beginning, tell, passed
        self.with_effect: Callable[[float, str, Any], None] | None = None
        self._last = 0
        # Two generations: the older one is dropped as a whole, which costs nothing for each cause.
        self._young: dict[int, Link] = {}
        self._old: dict[int, Link] = {}
        self._commands: dict[str, tuple[int, float]] = {}
        """By topic, the parent of the command recorded last, and when."""
        self._held: dict[str, int] = {}
        """By topic, the newest command that was not recorded."""

    def listen_to(self, trace: Callable[[Tracer | None], None]) -> Callable[[], None]:
        """Be the tracer of a system, which *trace* sets; gives what ends it."""
        trace(self)

        def end() -> None:
            trace(None)
            self.flush(all_of_them=True)

        return end

    def link(self, kind: str, what: str, parent: Cause | None = None, about: object = None) -> Cause:
        """Make the next link of a chain, see `jacaros.trace.Tracer`."""
        self._last += 1
        made = Cause(self._last, parent.id if parent is not None else 0, kind, what)
        if kind in RECORDED:
            return made
        if kind == "sample":
            self._passed("in", what, about)
            about = _small(about)
        elif kind == "command":
            self._passed("out", what, about)
            if parent is None:
                return made
            about = _small(about)
        self._young[made.id] = Link(made, self._clock.now(), about)
        if len(self._young) > KEPT // 2:
            self._old, self._young = self._young, {}
        if kind == "act":
            self.need(made.id)
        elif kind == "command":
            self._command(made)
        return made

    def need(self, number: int) -> None:
        """Record a cause and what led to it, as far as that is not recorded yet and still remembered."""
        chain: list[Link] = []
        while (link := self._young.pop(number, None) or self._old.pop(number, None)) is not None:
            chain.append(link)
            number = link.cause.parent
        for link in reversed(chain):
            self._record(link)

    def _record(self, link: Link) -> None:
        cause, at = link.cause, round(link.at - self._beginning, 3)
        more = _details(cause.kind, cause.what, link.about) if link.about is not None else {}
        self._tell("cause", {**cause._asdict(), "at": at, **more})
        if self.with_effect is not None and cause.kind in ("sample", "command") and link.about is not None:
            self.with_effect(at, cause.what, link.about)

    def _command(self, made: Cause) -> None:
        now = self._clock.elapsed
        parent, before = self._commands.get(made.what, (0, 0.0))
        if parent == made.parent and now - before < COMMAND_PERIOD:
            self._held[made.what] = made.id
            return
        self._commands[made.what] = made.parent, now
        held = self._held.pop(made.what, None)
        if held is not None and parent != made.parent:
            self.need(held)  # the last one of the operation before
        self.need(made.id)

    def flush(self, all_of_them: bool = False) -> None:
        """Record the last command of each topic that was held back long enough; to be called a few times a second."""
        now = self._clock.elapsed
        for topic, number in list(self._held.items()):
            parent, before = self._commands[topic]
            if all_of_them or now - before >= COMMAND_PERIOD:
                del self._held[topic]
                self._commands[topic] = parent, now
                self.need(number)


def _small(message: Any) -> Any:
    """Return a message that may be remembered, None for a large one."""
    data = getattr(message, "data", ())
    return message if not hasattr(data, "__len__") or len(data) < LARGE else None


def _details(kind: str, what: str, about: Any) -> dict[str, Any]:
    """Return further fields of a record, for what a link of a kind is about."""
    make = _DETAILS.get(kind)
    return make(what, about) if make is not None else {}


def _message_details(topic: str, message: Any) -> dict[str, Any]:
    shown = message_text(message)
    return {"topic": topic, "what": limited(f"{topic}: {shown}" if shown else topic)}


def _change_details(_: str, about: Any) -> dict[str, Any]:
    artifact, signals, changes = about
    new = [call_text(signal.name, signal.arguments) for signal in signals]
    new += [call_text(now.name, now.values) for _, now in changes.changed]
    new += [call_text(each.name, each.values) for each in changes.added]
    new += [f"-{call_text(each.name, each.values)}" for each in changes.removed]
    return {"artifact": artifact.path, "what": limited(f"{artifact.path} {', '.join(new)}")}


def _operation_details(_: str, request: Any) -> dict[str, Any]:
    return {"artifact": request.artifact.path, "what": request_text(request)}


def _act_details(_: str, about: Any) -> dict[str, Any]:
    agent, act = about
    return {"agent": agent, "intention": act.intention, **(act.place or {})}


_DETAILS: Mapping[str, Callable[[str, Any], dict[str, Any]]] = {
    "sample": _message_details,
    "command": _message_details,
    "property": _change_details,
    "signal": _change_details,
    "operation": _operation_details,
    "act": _act_details,
}
