"""Records of causes. Only causes that led to something are recorded."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.look.records.words import call_text, limited, message_text, request_text
from jacaros.runtime.clock import Clock
from jacaros.runtime.trace import Cause, Origin

_GENERATION = 4096
"""Number of causes that are kept at least, until something needs them; at most twice as many."""
COMMAND_PERIOD = 2.0
"""Seconds between two recorded commands of one operation on one topic. The last command, and the first one that stops
the robot, are recorded, too.
"""
RECORDED = ("event", "message")
"""Links with records of their own: deliberations and messages. Their causes are recorded with these."""
_CHANGES = ("property", "signal")
_WITH_ORIGIN = ("act", "operation", "remote")
LARGE = 4096
"""Number of elements in the field ``data`` from which on a message, such as an image, is not kept."""

CauseLink = tuple[Cause, float, Any]
"""A cause, its time (by the clock, which continues during a pause on a real graph), and its subject."""


class _Received(Cause):
    """A message as a cause, with the message in its fields.

    Most messages have no effect. Keeping even 64 of them makes a run 10 % slower, because new messages then need new
    memory. So a message lives as long as its cause.
    """

    __slots__ = ()


class Traffic:
    """The messages of one topic that our node received or sent.

    Attributes:
        topic: absolute name.
        count: number of messages. A reader may reset it.
        outgoing: whether our node sends them.
        heard: takes each message, or None.
        kept: whether messages are small enough to be kept.
        moves, plain: whether messages are velocities, and whether they are geometry_msgs/Twist instead of TwistStamped.
        parent, at, stands: of the last recorded command: its cause (an id), its time, and whether it was a stop.
        held: the newest command that was not recorded: its cause, time (`elapsed` of the clock), and message.
    """

    __slots__ = (
        "at",
        "count",
        "heard",
        "held",
        "kept",
        "moves",
        "outgoing",
        "parent",
        "plain",
        "stands",
        "topic",
    )

    def __init__(self, topic: str, outgoing: bool, message: Any) -> None:
        self.topic, self.outgoing, self.count = topic, outgoing, 0
        self.heard: Callable[[str, Any], None] | None = None
        self.kept = _is_small(message)
        self.plain = hasattr(message, "linear")
        self.moves = self.plain or hasattr(getattr(message, "twist", None), "linear")
        self.parent, self.at, self.stands = 0, 0.0, False
        self.held: tuple[Cause, float, Any] | None = None


class CauseRecords:
    """Numbers the causes of a run, and records causal chains: each link once, as soon as something needs it.

    Actions and commands need a chain, and callers of `need`. See ``docs/reference/recordings.md`` for the fields of the
    record ``cause``.

    Args:
        clock: clock of the run.
        beginning: seconds of the clock from which ``at`` counts.
        tell: takes the records.
        find_listener: returns a listener for the messages of a topic, given one of them; or None.

    Attributes:
        received, sent: the messages of our node by topic.
    """

    def __init__(
        self,
        clock: Clock,
        beginning: float,
        tell: RecordSink,
        find_listener: Callable[[Any], Callable[[str, Any], None] | None] = lambda message: None,
    ) -> None:
        self._clock, self._tell, self._find_listener = clock, tell, find_listener
        self._beginning = beginning
        self.received: dict[str, Traffic] = {}
        self.sent: dict[str, Traffic] = {}
        self._last = 0
        # Two generations: the older one is dropped as a whole, at no cost per cause.
        self._young: dict[int, CauseLink] = {}
        self._old: dict[int, CauseLink] = {}
        self._samples: set[int] = set()
        """Messages that have led to something. Each is kept, or recorded, once."""
        self._origins: dict[int, Origin] = {}
        """The steps that led to operations, by their links."""

    def link(self, kind: str, what: str, parent: Cause | None = None, about: Any = None) -> Cause:
        """Create the next link of a chain. See `jacaros.runtime.trace.Tracer`."""
        self._last = number = self._last + 1
        made = Cause(number, 0 if parent is None else parent.id, kind, what)
        if kind in RECORDED:
            return made
        if isinstance(parent, _Received):
            self._keep_sample(parent, about if kind in _CHANGES else None)
        self._young[number] = made, self._clock.now(), about
        if len(self._young) > _GENERATION:
            self._old, self._young = self._young, {}
        if kind in ("act", "operation"):
            self.need(made)
        if kind in _WITH_ORIGIN:
            self._note_origin(made, parent, about)
        return made

    def _note_origin(self, made: Cause, parent: Cause | None, about: Any) -> None:
        origin = about
        if made.kind == "act":
            agent, act = about
            place, event = (
                act.place or {},
                parent.what if parent is not None and parent.kind == "event" else "",
            )
            origin = Origin(agent, event, place.get("file", ""), place.get("line", 0))
        elif made.kind == "operation":
            origin = None if parent is None else self._origins.get(parent.id)
        if origin is not None:
            self._origins[made.id] = origin
            if len(self._origins) > _GENERATION:
                del self._origins[next(iter(self._origins))]

    def origin(self, cause: Cause) -> Origin | None:
        """Return the step that led to a recent link. See `jacaros.runtime.trace.Tracer`."""
        return self._origins.get(cause.id) or self._origins.get(cause.parent)

    def received_message(self, topic: str, message: Any) -> Cause:
        """Create the first link of a chain. See `jacaros.runtime.trace.Tracer`."""
        # Called for each sensor message: most of the cost of a recording would be here.
        try:
            traffic = self.received[topic]
        except KeyError:
            traffic = self._traffic(topic, message)
        traffic.count += 1
        if traffic.heard is not None:
            traffic.heard(topic, message)
        self._last = number = self._last + 1
        kept = message if traffic.kept else None
        return tuple.__new__(_Received, (number, 0, "sample", topic, kept))

    def _keep_sample(self, cause: Cause, effect: Any = None) -> None:
        """Keep a message that has led to something, until something needs it, with the change that it led to first."""
        if cause.id not in self._samples:
            if len(self._samples) > _GENERATION:
                self._samples.clear()
            self._samples.add(cause.id)
            link: tuple[Any, ...] = tuple(cause)
            # The effects of a message occur in the same pass of the event loop.
            self._young[cause.id] = Cause(*link[:4]), self._clock.now(), link[4] and (link[4], effect)

    def sent_message(self, topic: str, message: Any, parent: Cause | None) -> None:
        """Create the last link of a chain, see `jacaros.runtime.trace.Tracer`.

        Frequent commands of one operation are thinned out.
        """
        try:
            traffic = self.sent[topic]
        except KeyError:
            traffic = self.sent[topic] = Traffic(topic, True, message)
        traffic.count += 1
        if parent is None:
            return
        now = self._clock.elapsed
        stands = False
        if traffic.moves:
            velocity = message.linear if traffic.plain else message.twist.linear
            turn = message.angular if traffic.plain else message.twist.angular
            stands = not (velocity.x or turn.z or velocity.y)
        if traffic.parent == parent.id and now - traffic.at < COMMAND_PERIOD and stands == traffic.stands:
            traffic.held = parent, now, message
            return
        if traffic.held is not None and traffic.parent != parent.id:
            self._record_command(traffic, *traffic.held)  # the last command of the previous operation
        traffic.stands = stands
        self._record_command(traffic, parent, now, message)

    def _record_command(self, traffic: Traffic, parent: Cause, elapsed: float, message: Any) -> None:
        traffic.parent, traffic.at, traffic.held = parent.id, self._clock.elapsed, None
        moment = self._clock.now() - (traffic.at - elapsed)
        self.need(parent)
        self._last += 1
        made = Cause(self._last, parent.id, "command", traffic.topic)
        self._record((made, moment, message if traffic.kept else None))

    def need(self, cause: Cause) -> None:
        """Record a cause and its own causes, as far as they are not recorded yet and still known."""
        if isinstance(cause, _Received):
            self._keep_sample(cause)
        number = cause.id
        chain: list[CauseLink] = []
        while (link := self._young.pop(number, None) or self._old.pop(number, None)) is not None:
            chain.append(link)
            number = link[0].parent
        for link in reversed(chain):
            self._record(link)

    def _record(self, link: CauseLink) -> None:
        (number, parent, kind, what), moment, about = link
        at = round(moment - self._beginning, 3)
        record = records.CauseRecord(number, kind, what, parent, at)
        if about is not None and kind in _DETAILS:
            for field, value in _DETAILS[kind](what, about).items():
                setattr(record, field, value)
        self._tell(record)

    def _traffic(self, topic: str, message: Any) -> Traffic:
        traffic = self.received[topic] = Traffic(topic, False, message)
        traffic.heard = self._find_listener(message)
        return traffic

    def flush(self, all_of_them: bool = False) -> None:
        """Record the last command of each topic that was held back long enough. Call it a few times a second."""
        now = self._clock.elapsed
        for traffic in self.sent.values():
            if traffic.held is not None and (all_of_them or now - traffic.at >= COMMAND_PERIOD):
                self._record_command(traffic, *traffic.held)


def _is_small(message: Any) -> bool:
    data = getattr(message, "data", ())
    return not hasattr(data, "__len__") or len(data) < LARGE


def _sample_details(topic: str, about: Any) -> dict[str, Any]:
    message, effect = about
    return _message_details(topic, message, () if effect is None else _values_of(*effect))


def _values_of(_: Any, signals: Any, changes: Any) -> Iterator[Any]:
    """Return the values of a change, for telling which field of a message mattered."""
    for signal in signals:
        yield from signal.arguments
    for now in (*(each for _, each in changes.changed), *changes.added):
        yield from now.values


def _message_details(topic: str, message: Any, effect: Iterable[object] = ()) -> dict[str, Any]:
    shown = message_text(message, effect)
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


def _origin_details(_: str, origin: Origin) -> dict[str, Any]:
    return {"agent": origin.agent, "file": origin.file, "line": origin.line}


_DETAILS: Mapping[str, Callable[[str, Any], dict[str, Any]]] = {
    "sample": _sample_details,
    "command": _message_details,
    "property": _change_details,
    "signal": _change_details,
    "operation": _operation_details,
    "act": _act_details,
    "remote": _origin_details,
}
"""Further fields of a record, for what a link of a kind is about."""
