"""Topics of a mapped artifact: each message updates the properties and signals that show parts of it.

For an array there is one property per element: new elements are defined, changed ones updated, missing ones removed.
"""

import dataclasses
import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

from jacaros.artifacts.env.values import Structure
from jacaros.robots.kit.reading import BadMessages, Reading, Stamps
from jacaros.robots.mapping.decoding import Extract, Unshowable, ValueRow, extractor
from jacaros.robots.mapping.deriving import stamp_of
from jacaros.robots.mapping.host import LOOK, MappingHost, type_in
from jacaros.robots.mapping.properties import TopicPart
from jacaros.robots.ros.backend import GraphContents
from jacaros.robots.ros.errors import CapabilityMissing, RosError
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.node import Sample, Subscription
from jacaros.robots.ros.qos import SENSOR_DATA, STATE
from jacaros.robots.ros.waiting import MISSING_AFTER
from jacaros.runtime.files.yaml import Problem
from jacaros.runtime.trace import Cause


class MappedTopic:
    """Deliver the messages of one subscription to all its properties and signals.

    Args:
        host: the artifact.
        updaters: receive the messages; they have the same topic, type and quality of service.

    Attributes:
        written: the topic.
        name: its absolute name.
    """

    def __init__(self, host: MappingHost, updaters: "list[Updater]") -> None:
        topic = updaters[0].part.topic
        assert topic is not None
        self.written, self.name = topic, host.ros.resolve(host.robot_topic(topic.text))
        self._host, self._updaters = host, updaters
        self._stamps: Stamps | None = None
        self._subscription: Subscription | None = None

    def listen(self, type_name: str) -> None:
        """Subscribe. Without a quality of service in the mapping it is that of a sensor; a property also receives
        stored messages."""
        host, written = self._host, self.written
        problems: list[Problem] = []
        for updater in self._updaters:
            updater.prepare(type_name, problems)
        if problems:
            host.report(problems)
        self._updaters = [updater for updater in self._updaters if updater.ready]
        if not self._updaters:
            return
        if "header" in host.ros.fields(type_name) and any(updater.is_state for updater in self._updaters):
            self._stamps = Stamps(host.faults_at(self.name), host.clock)
        report = host.on_topic_event(written.text, written.place)
        try:
            states = any(not updater.part.signal for updater in self._updaters)
            qos = self._updaters[0].part.qos or (STATE if states else SENSOR_DATA)
            self._subscription = host.subscription(written.text, type_name, self._take, qos, report)
        except CapabilityMissing as error:
            host.fail(f"{host.mapping.where(written.place)}: {error}", "ros_error", host.name)

    def _take(self, sample: Sample) -> None:
        stamps = self._stamps
        # Latched messages are old when they arrive, and valid.
        latched = self._subscription is not None and self._subscription.latched
        old = (
            not latched
            and stamps is not None
            and not stamps.accept(to_seconds(sample.message.header.stamp), sample.stamp)
        )
        for updater in self._updaters:
            if not (old and updater.is_state):
                updater.take(sample, latched)


async def find_types(host: MappingHost, topics: list[MappedTopic]) -> None:
    """Query the graph until the types of *topics* are known, and subscribe to them; a process of the artifact."""
    began, told, missed = host.clock.elapsed, False, False
    while topics:
        try:
            contents = await host.step(host.ros.contents())
        except CapabilityMissing as error:
            for each in topics:
                help = "write the type: type: package/msg/Type"
                host.report_once(each, each.written.place, str(error), help)
            return
        except RosError:
            contents = GraphContents()
        for each in list(topics):
            if found := type_in(contents, "topic", each.name):
                topics.remove(each)
                each.listen(found)
        if not topics:
            return
        if not told:
            for each in topics:
                host.log(f"waiting for topic {each.name}, to find its type")
        late = host.clock.elapsed - began >= MISSING_AFTER
        if late and not missed:
            for each in topics:
                text = f"no node uses topic {each.name}, so its type is unknown; still waiting"
                help = "start the node that publishes it, or write its type: type: package/msg/Type"
                host.report_once(each, each.written.place, text, help)
        told, missed = True, missed or late
        await host.sleep(LOOK)


Show = Callable[[list[ValueRow], Cause | None], None]
"""Shows the rows of a message."""


class Updater:
    """Update a property, or send signals, from messages.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: MappingHost, part: TopicPart) -> None:
        self.part = part
        self._host = host
        self._extract: Extract | None = None
        self._reading: Reading | None = None
        self._faults: BadMessages | None = None
        self._taps = host.taps.get(part.name, ())
        self._latched = False
        self._frame = host.frame(part.frame.text) if part.frame is not None else None
        if part.signal:
            self._take_rows: Show = Signals(host, part).take
        elif part.each is not None:
            self._take_rows = Elements(host, part).take
        else:
            self._reading = host.reading_of(part.name, part.policy)
            self._take_rows = partial(self._show, self._reading)

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
        if self._frame is not None:
            message: Any = sample.message
            given = message.header.frame_id.strip("/")
            if given != self._frame:
                text = f"expected frame {self._frame}, found {given or 'none'}"
                wrong = Unshowable(given, text, "if that is its frame, write it", "wrong_frame")
                self._refuse(wrong, sample.topic)
                return
        self.take_message(sample.message, sample.cause, sample.topic)

    def take_message(self, message: object, cause: Cause | None, topic: str) -> None:
        """Handle a message, or the feedback of an action."""
        assert self._extract is not None
        try:
            rows = self._extract(message)
        except Unshowable as error:
            self._refuse(error, topic)
            return
        if self._taps:
            stamp = stamp_of(message, self._latched)
            for tap in self._taps:
                for row in rows:
                    tap(stamp, row.values, cause)
        self._take_rows(rows, cause)

    def _show(self, reading: Reading, rows: list[ValueRow], cause: Cause | None) -> None:
        reading.take(rows[0].values, cause)

    def withdraw(self) -> None:
        """Remove the property."""
        if self._reading is not None:
            self._reading.withdraw()

    def _refuse(self, error: Unshowable, topic: str) -> None:
        """Report a message that was not shown: by one log line with the position, and by a signal to agents."""
        part, host = self.part, self._host
        text = f"`{part.name}` is not shown: {error}"
        host.report_once((part.name, error.path), part.place, text, error.help)
        if self._faults is None:
            self._faults = BadMessages(topic, lambda why, _: host.start(host.report_bad_message, topic, why))
        self._faults.add(Structure(error.functor, (error.path,)), str(error))


class Signals:
    """The signals of a topic: all, or those that differ from the last ones.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: MappingHost, part: TopicPart) -> None:
        self._host, self._part = host, part
        self._sent: dict[object, tuple[object, ...]] = {}

    def take(self, rows: list[ValueRow], cause: Cause | None) -> None:
        """Handle a message."""
        if self._part.when_changed:
            before, self._sent = self._sent, {row.key: row.values for row in rows}
            rows = [row for row in rows if before.get(row.key) != row.values]
        if rows:
            values = [row.values for row in rows]
            self._host.start(self._host.send_signals, self._part.name, values, cause=cause)


class Elements:
    """The elements of the newest message, by their keys.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: MappingHost, part: TopicPart) -> None:
        self._host, self._part = host, part
        self._wanted: dict[object, ValueRow] = {}
        self._shown: dict[object, ValueRow] = {}
        self._versions = itertools.count()
        self._coming = False
        policy = dataclasses.replace(part.policy, dead_band=0.0)
        self._reading = Reading(policy, host.clock, self._deliver, behind=self._is_behind)
        host.at_dispose(self._reading.close)

    def take(self, rows: list[ValueRow], cause: Cause | None) -> None:
        """Handle the elements of a message."""
        new = {row.key: self._kept(row) for row in rows}
        if new != self._wanted:
            self._wanted = new
            self._reading.take((next(self._versions),), cause)

    def _kept(self, row: ValueRow) -> ValueRow:
        """Return the row that is already shown if the new one hardly differs."""
        old = self._wanted.get(row.key)
        return row if old is None or self._part.policy.differ(old.values, row.values) else old

    def _is_behind(self) -> bool:
        return self._coming or self._host.has_untaken(self._part.name)

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
                host.define_property(name, *row.values)
            elif old != row:
                host.update_property(name, *row.values, where=old.values)
