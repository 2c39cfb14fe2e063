"""Topics of a mapped artifact: each message updates the properties and signals that show parts of it.

For an array there is one property per element: new elements are defined, changed ones updated, missing ones removed.
"""

import dataclasses
import itertools
from typing import Any

from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.kit.faults import Faults, Stamps
from jacaros.artifacts.kit.reading import Outlet, Reading
from jacaros.artifacts.kit.sensing_artifact import RangeOfView
from jacaros.artifacts.mapping.declared import TopicPart, Written
from jacaros.artifacts.mapping.decoding import Unshowable, perceived
from jacaros.artifacts.mapping.deriving import stamp_of
from jacaros.artifacts.mapping.host import Host
from jacaros.artifacts.mapping.rows import Extract, Row, extractor
from jacaros.artifacts.mapping.type_search import TypeSearch
from jacaros.files.yaml import Problem
from jacaros.ros.errors import CapabilityMissing
from jacaros.ros.message import to_seconds
from jacaros.ros.node import Sample, Subscription
from jacaros.ros.qos import SENSOR_DATA, STATE, QoS
from jacaros.runtime.clock import Timer
from jacaros.runtime.trace import Cause


class TopicMultiplexer:
    """Deliver the messages of one subscription to all its properties and signals.

    Args:
        host: the artifact.
        written: the topic.
        type_name: message type; None: found at run time.
        qos: the quality of service in the mapping; None: that of a sensor, and a property also receives stored
            messages.
        updaters: receive the messages.
    """

    def __init__(
        self,
        host: Host,
        written: Written,
        type_name: Written | None,
        qos: QoS | None,
        updaters: "list[Updater]",
    ) -> None:
        self.updaters = updaters
        self._host, self._written, self._type_name = host, written, type_name
        self._qos = qos
        self._stamps: Stamps | None = None
        self._subscription: Subscription | None = None

    def begin(self, search: TypeSearch) -> None:
        """Subscribe as soon as the type is known."""
        if self._type_name is not None:
            self._listen(self._type_name.text)
        else:
            search.want(self._written, self._listen)

    def _listen(self, type_name: str) -> None:
        host, written = self._host, self._written
        problems: list[Problem] = []
        for updater in self.updaters:
            updater.prepare(type_name, problems)
        if problems:
            host.report(problems)
        self.updaters = [updater for updater in self.updaters if updater.ready]
        if not self.updaters:
            return
        if "header" in host.ros.fields(type_name) and any(updater.is_state for updater in self.updaters):
            topic = host.ros.resolve(host.robot_topic(written.text))
            self._stamps = Stamps(host.faults_at(topic), host.clock)
        report = host.on_topic_event(written.text, written.place)
        try:
            states = any(not updater.part.signal for updater in self.updaters)
            qos = self._qos or (STATE if states else SENSOR_DATA)
            self._subscription = host.subscription(written.text, type_name, self._take, qos, report)
        except CapabilityMissing as error:
            host.fail(f"{host.mapping.where(written.place)}: {error}", "ros_error", host.name)

    def _take(self, sample: Sample) -> None:
        stamps = self._stamps
        # Latched messages are old when they arrive, and valid.
        latched = self._subscription is not None and self._subscription.latched
        old = (
            not latched and stamps is not None and not stamps.accept(_stamp_of(sample.message), sample.stamp)
        )
        for updater in self.updaters:
            if not (old and updater.is_state):
                updater.take(sample, latched)


def _stamp_of(message: Any) -> float:
    return to_seconds(message.header.stamp)


class Updater:
    """Update a property, or send signals, from messages.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: Host, part: TopicPart) -> None:
        self.part = part
        self._host = host
        self._extract: Extract | None = None
        self._reading: Reading | None = None
        self._elements: Elements | None = None
        self._faults: Faults | None = None
        self._sent: dict[object, tuple[object, ...]] = {}
        self._held: tuple[list[Row], Cause | None] | None = None
        self._pause: Timer | None = None
        self._taps = host.taps.get(part.name, ())
        self._latched = False
        host.at_dispose(self._end_pause)
        if part.each is not None and not part.signal:
            self._elements = Elements(host, part)
        elif not part.signal:
            self._reading = host.reading_of(part.name, part.policy, *map(perceived, part.initial or ()))
        self._view = self._range_of_view()
        self._frame = host.frame(part.frame.text) if part.frame is not None else None

    def _range_of_view(self) -> RangeOfView | None:
        view = self.part.view
        if view is None or view.distance is not None:
            return None

        def show(seen: list[tuple[object, ...]], cause: Cause | None) -> None:
            self._show([row for *_, row in seen if isinstance(row, Row)], cause)

        made = RangeOfView(view.metres, show)
        if view.origin is None:
            made.stand(0.0, 0.0)
        else:
            self._host.follow_property(view.origin.text, lambda values: _stand(made, values))
        return made

    @property
    def is_state(self) -> bool:
        """Whether only the newest message counts: not for signals, nor if each message contains only some elements."""
        return not self.part.signal and self.part.each is None

    @property
    def ready(self) -> bool:
        """Whether the type is known and has all fields."""
        return self._extract is not None

    def prepare(self, type_name: str, problems: list[Problem]) -> None:
        """Prepare for messages of a type; *problems* receives mismatches."""
        self._extract = extractor(self.part, type_name, self._host.ros, problems)

    def take(self, sample: Sample, latched: bool) -> None:
        """Handle a message; *latched*: its stamp may be old."""
        self._latched = latched
        if self._frame is None or self._is_in_frame(sample, self._frame):
            self.take_message(sample.message, sample.cause, sample.topic)

    def _is_in_frame(self, sample: Sample, wanted: str) -> bool:
        message: Any = sample.message
        given = message.header.frame_id.strip("/")
        if given == wanted:
            return True
        text = f"expected frame {wanted}, found {given or 'none'}"
        self._refuse(Unshowable(given, text, "if that is its frame, write it", "wrong_frame"), sample.topic)
        return False

    def take_message(self, message: object, cause: Cause | None, topic: str) -> None:
        """Handle a message, or the feedback of an action."""
        assert self._extract is not None
        try:
            rows = self._extract(message)
        except Unshowable as error:
            self._refuse(error, topic)
            return
        if self._taps:
            self._tell_taps(message, rows, cause)
        if self._view is not None:
            self._view.take([(*row.place, row) for row in rows], cause)
        else:
            self._show(rows, cause)

    def _tell_taps(self, message: object, rows: list[Row], cause: Cause | None) -> None:
        stamp = stamp_of(message, self._latched)
        for tap in self._taps:
            for row in rows:
                tap(stamp, row.values, cause)

    def _show(self, rows: list[Row], cause: Cause | None) -> None:
        if self.part.signal:
            self._signal(rows, cause)
        elif self._elements is not None:
            self._elements.take(rows, cause)
        elif self._reading is None:
            return
        elif rows:
            self._host.annotate(self.part.name, rows[0].annotations)
            self._reading.take(rows[0].values, cause)
        elif self._reading.newest is not None:
            self._reading.withdraw()

    def _signal(self, rows: list[Row], cause: Cause | None) -> None:
        if self._pause is not None:
            self._held = (rows, cause)  # keep the newest
            return
        if self.part.when_changed:
            before, self._sent = self._sent, {row.key: row.values for row in rows}
            rows = [row for row in rows if before.get(row.key) != row.values]
        if not rows:
            return
        if (rate := self.part.policy.rate) is not None:
            self._pause = self._host.clock.call_later(1.0 / rate, self._go_on)
        self._host.start(self._host.send_signals, self.part.name, [row.values for row in rows], cause=cause)

    def _go_on(self) -> None:
        """Continue after the pause that follows a signal."""
        self._pause = None
        if self._held is not None:
            held, self._held = self._held, None
            self._signal(*held)

    def _end_pause(self) -> None:
        if self._pause is not None:
            self._pause.cancel()

    def withdraw(self) -> None:
        """Remove the property."""
        if self._reading is not None:
            self._reading.withdraw()

    def _refuse(self, error: Unshowable, topic: str) -> None:
        """Report a message that was not shown: by one log line with the position, and by a signal to agents."""
        part, host = self.part, self._host
        host.report_once(
            (part.name, error.path), part.place, f"`{part.name}` is not shown: {error}", error.help
        )
        if self._faults is None:

            def report(why: Structure, text: str) -> None:
                host.start(host.report_bad_message, topic, why)

            self._faults = Faults(topic, report)
        self._faults.add(Structure(error.functor, (error.path,)), str(error))


def _stand(view: RangeOfView, values: tuple[object, ...]) -> None:
    """Use the position in a property as origin."""
    x, y = (*values, 0, 0)[:2]
    if isinstance(x, int | float) and isinstance(y, int | float):
        view.stand(float(x), float(y))


def feedback_updater(host: Host, part: TopicPart) -> Updater:
    """Make a property from the feedback of an action; it exists while there is a goal."""
    return Updater(host, dataclasses.replace(part, initial=None))


class Elements:
    """The elements of the newest message, by their keys.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: Host, part: TopicPart) -> None:
        self._host, self._part = host, part
        self._wanted: dict[object, Row] = {}
        self._shown: dict[object, Row] = {}
        self._seen: dict[object, float] = {}
        self._expiry: Timer | None = None
        self._versions = itertools.count()
        self._coming = False
        policy = dataclasses.replace(part.policy, dead_band=0.0, expire=None)
        outlet = Outlet(behind=lambda: self._coming or host.has_untaken(part.name))
        self._reading = Reading(policy, host.clock, self._deliver, outlet)
        host.at_dispose(self.close)

    def take(self, rows: list[Row], cause: Cause | None) -> None:
        """Handle the elements of a message."""
        now, expire = self._host.clock.elapsed, self._part.policy.expire
        new = {row.key: self._kept(row) for row in rows}
        if expire is not None:
            self._seen.update(dict.fromkeys(new, now))
            new = {**self._alive(now, expire), **new}
            if self._expiry is None:
                self._expiry = self._host.clock.call_later(expire, self._look)
        self._want(new, cause)

    def _kept(self, row: Row) -> Row:
        """Return the row that is already shown if the new one hardly differs."""
        old = self._wanted.get(row.key)
        if old is None or self._part.policy.differ(old.values, row.values):
            return row
        return old

    def _want(self, new: dict[object, Row], cause: Cause | None) -> None:
        if new != self._wanted:
            self._wanted = new
            self._reading.take((next(self._versions),), cause)

    def _deliver(self, values: tuple[object, ...], cause: Cause | None) -> None:
        self._coming = True
        self._host.start(self._host.show_property, self._part.name, self.show, cause=cause)

    def show(self) -> None:
        """Update the properties, within an operation."""
        self._coming = False
        host, name = self._host, self._part.name
        before, self._shown = self._shown, self._wanted
        for key, row in before.items():
            if key not in self._shown:
                host.remove_property(name, *row.values)
        for key, row in self._shown.items():
            old = before.get(key)
            if old is None:
                host.define_property(name, *row.values, annotations=row.annotations)
            elif old != row:
                host.update_property(name, *row.values, annotations=row.annotations, where=old.values)

    def _alive(self, now: float, expire: float) -> dict[object, Row]:
        """Return the elements that were seen recently."""
        alive = {
            key: row for key, row in self._wanted.items() if now - self._seen.get(key, now) < expire - 1e-9
        }
        self._seen = {key: at for key, at in self._seen.items() if key in alive or at == now}
        return alive

    def _look(self) -> None:
        expire = self._part.policy.expire
        assert expire is not None
        now = self._host.clock.elapsed
        alive = self._alive(now, expire)
        self._want(alive, None)
        self._expiry = None
        if alive:
            oldest = min(self._seen.get(key, now) for key in alive)
            self._expiry = self._host.clock.call_later(max(0.001, oldest + expire - now), self._look)

    def close(self) -> None:
        """Stop the timer."""
        self._reading.close()
        if self._expiry is not None:
            self._expiry.cancel()
