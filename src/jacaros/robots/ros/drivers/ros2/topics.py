"""Topics of ROS 2: publishers and subscriptions, and the events of subscriptions."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from rclpy.duration import Duration  # type: ignore[import-not-found]
from rclpy.event_handler import (  # type: ignore[import-not-found]
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)

from jacaros.robots.ros.drivers.ros2.graph import endpoint, foreign_types, profile, publishers_in
from jacaros.robots.ros.drivers.ros2.node import AGAIN, SENDING, STOPPING_ROBOTS, Ros2Node
from jacaros.robots.ros.drivers.ros2.receiving import RCLError
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.robots.ros.handoff import Handoff, post
from jacaros.robots.ros.node import SubscriptionOptions, TopicPublisher, TopicSubscription
from jacaros.robots.ros.qos import QoS, available, incompatibility

NO_TIME = Duration()
REPETITIONS = 4
"""Minimum number of repetitions of the zero velocity that ends a run."""
LOOKING = 2.0
"""Seconds between two checks of the publishers of a silent topic: ROS 2 does not report other types."""

LIVELY = 2
"""Number of messages between two checks from which a later silence is a reason to check the publisher's liveness."""
TRUSTED = 60.0
"""Seconds for which a live publisher is not checked again."""


@contextmanager
def _at_topic(node: Ros2Node, topic: str, type_name: str) -> Iterator[None]:
    """Translate rclpy's errors about topics that cannot be joined."""
    try:
        yield
    except RCLError as problem:
        ours = {
            getattr(each, "type_name", "") for each in node.members if getattr(each, "topic", "") == topic
        }
        others = ", ".join(sorted(ours - {type_name}))
        because = f"this node already uses it with type {others}" if others else str(problem)
        raise RosError(f"topic {topic} cannot be used with type {type_name}: {because}") from None


class Ros2Publisher(TopicPublisher[Ros2Node]):
    """Publisher of the ``ros2`` backend."""

    def __init__(self, node: Ros2Node, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        events = PublisherEventCallbacks(
            incompatible_qos=lambda _: post(node.loop, self._compare_qos) and None,
            use_default_callbacks=False,
        )
        with _at_topic(node, topic, type_name):
            self._publisher: Any = node.rcl.create_publisher(
                self._class, topic, profile(qos), event_callbacks=events
            )
        self._last: Any = None
        """The last message, if it is a velocity."""
        self._repeated, self._repeat_at = 0, 0.0
        self._stops_robots = type_name in VELOCITIES
        node.unsent[self._sent] = STOPPING_ROBOTS if self._stops_robots else SENDING

    @property
    def subscription_count(self) -> int:
        """Number of connected subscriptions."""
        return 0 if self._closed else int(self._publisher.get_subscription_count())

    def _send(self, message: Any) -> None:
        self._publisher.publish(message)
        if self._stops_robots:
            self._last, self._repeated = message, 0

    def _sent(self) -> bool:
        """Return whether all messages have arrived; while the node is leaving, repeat a zero velocity that may be lost.

        Receivers notice a lost message by a later one. Best-effort receivers acknowledge nothing.
        """
        acknowledged = bool(self._publisher.wait_for_all_acked(NO_TIME))
        velocity = getattr(self._last, "twist", self._last)
        stops = velocity is not None and velocity == type(velocity)()
        if not stops or not self._node.lifetime.leaving or (acknowledged and self._repeated >= REPETITIONS):
            return acknowledged
        now = time.monotonic()
        if now >= self._repeat_at:
            self._repeated, self._repeat_at = self._repeated + 1, now + AGAIN
            self._publisher.publish(self._last)
        return False

    def _leave(self) -> None:
        node = self._node
        node.destroy_entity_later(node.rcl.destroy_publisher, self._publisher, self._sent)

    def _compare_qos(self) -> None:
        """Log which subscriptions request more than is offered."""
        if self._closed or self._node.ended:
            return
        for info in self._node.rcl.get_subscriptions_info_by_topic(self.topic):
            listener = endpoint(info)
            reason = None if listener.qos is None else incompatibility(self.qos, listener.qos)
            if reason is not None:
                who = listener.node or "an unknown node"
                text = f"topic {self.topic}: incompatible QoS: {who} does not receive what is published here: {reason}"
                self.report(text, bytes(info.endpoint_gid))


class Ros2Subscription(TopicSubscription[Ros2Node]):
    """Subscription of the ``ros2`` backend."""

    def __init__(self, node: Ros2Node, wanted: SubscriptionOptions) -> None:
        super().__init__(node, wanted)
        self._queue: Handoff[Any] = Handoff(node.loop, self.qos.depth, self.deliver)
        self._silent = True
        self._lively = 0
        self._missing: frozenset[bytes] = frozenset()
        self._trusted_until = 0.0
        self._deadline_missed = False
        self._requested = self.qos
        self.qos = available(self._requested, self._offers())
        self._subscription = self._subscribe()
        self._timer = node.loop.call_later(LOOKING, self._look)

    def _subscribe(self) -> Any:
        node = self._node
        with _at_topic(node, self.topic, self.type_name):
            made = node.rcl.create_subscription(
                node.factory.message_class(self.type_name),
                self.topic,
                self._queue.put,
                profile(self.qos),
                callback_group=node.receiver.group,
                event_callbacks=self._events(),
            )
        node.receiver.add(made, self._queue.put)
        return made

    def _offers(self) -> list[QoS | None]:
        return [endpoint(info).qos for info in self._node.rcl.get_publishers_info_by_topic(self.topic)]

    def _adapt(self) -> bool:
        """Subscribe again if the publishers now offer another durability. Return whether that was so."""
        if self._closed or self._node.ended or self._requested.durability != "best_available":
            return False
        offers = self._offers()
        qos = available(self._requested, offers)
        if not offers or qos == self.qos:
            return False
        old, self.qos = self._subscription, qos
        self._node.receiver.remove(old, partial(self._destroy, old))
        self._subscription = self._subscribe()
        return True

    @property
    def publisher_count(self) -> int:
        """Number of known publishers of the topic."""
        if self._closed:
            return 0
        if self._missing:
            return len(publishers_in(self._node.rcl, self.topic) - self._missing)
        return int(self._node.rcl.count_publishers(self.topic))

    def deliver(self, message: Any) -> None:
        """Deliver a message, on the loop."""
        self._silent = False
        self._missing = frozenset()
        self._deadline_missed = False
        super().deliver(message)
        self._node.delivered()

    def _leave(self) -> None:
        self._queue.close()
        self._timer.cancel()
        self._node.receiver.remove(self._subscription, partial(self._destroy, self._subscription))

    def _destroy(self, subscription: Any) -> None:
        self._node.destroy_entity(self._node.rcl.destroy_subscription, subscription)

    def _events(self) -> Any:
        def on_loop(action: Callable[[], object]) -> Callable[[Any], None]:
            def event(_: Any) -> None:
                post(self._node.loop, action)

            return event

        return SubscriptionEventCallbacks(
            deadline=on_loop(self._miss_deadline) if self.qos.deadline is not None else None,
            incompatible_qos=on_loop(self._compare_qos),
            matched=on_loop(self._adapt) if self._requested.durability == "best_available" else None,
            use_default_callbacks=False,
        )

    def _miss_deadline(self) -> None:
        # The middleware reports it again with every deadline that passes.
        first, self._deadline_missed = not self._deadline_missed, True
        self.report_deadline(first)

    def _compare_qos(self) -> None:
        """Find the incompatible publisher; the event itself names only one of the reasons."""
        if self._closed or self._adapt():
            return
        found = False
        for info in self._node.rcl.get_publishers_info_by_topic(self.topic):
            publisher = endpoint(info)
            reason = None if publisher.qos is None else incompatibility(publisher.qos, self.qos)
            if reason is not None:
                found = True
                self.report_qos(
                    reason, f" to {publisher.node or 'an unknown node'}", bytes(info.endpoint_gid)
                )
        if not found:
            self.report_qos("offer and request do not match", " to a publisher")

    def _look(self) -> None:
        """Check whether a silent topic carries another type: then no message ever arrives, without an error."""
        if self._closed or self._node.ended:
            return
        self._adapt()  # the event of a match may come before the middleware knows what is offered
        if self._silent and self.publisher_count:
            for other, who in foreign_types(self._node, self.topic, self.type_name).items():
                self.report_type_mismatch(who, other)
        if self._silent and self._lively >= LIVELY and time.monotonic() > self._trusted_until:
            self._doubt()
        self._lively = 0 if self._silent else self._lively + 1
        self._silent = True
        self._timer = self._node.loop.call_later(LOOKING, self._look)

    def _doubt(self) -> None:
        """Check the liveness of publishers whose regular messages have stopped."""
        suspects = publishers_in(self._node.rcl, self.topic)

        def report(missing: frozenset[bytes]) -> None:
            if self._silent:
                self._missing = missing
            if not missing:
                self._trusted_until = time.monotonic() + TRUSTED

        if suspects:
            self._node.check_liveness(lambda rcl: publishers_in(rcl, self.topic), suspects, report)
