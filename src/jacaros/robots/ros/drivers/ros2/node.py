"""A node of rclpy with a context of its own; next to the loop there is a thread for messages and one for everything
else.

Domain, discovery range and the middleware are configured as usual in ROS 2: ``ROS_DOMAIN_ID``,
``ROS_AUTOMATIC_DISCOVERY_RANGE``, ``RMW_IMPLEMENTATION``.
"""

import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

# Unless this is set before their import, rclpy's messages accept any value and publish it misread.
os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")

import rclpy  # type: ignore[import-not-found]
import rclpy.executors  # type: ignore[import-not-found]
import rclpy.signals  # type: ignore[import-not-found]
from rclpy.exceptions import ParameterException  # type: ignore[import-not-found]

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.ros2.liveness_check import Find, LivenessCheck, ReportLost
from jacaros.robots.ros.drivers.ros2.receiving import Receiver
from jacaros.robots.ros.drivers.ros2.types import RosidlSchema, parameter
from jacaros.robots.ros.errors import ParameterRefused
from jacaros.robots.ros.handoff import in_thread, post
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.node import NodeSettings
from jacaros.robots.ros.ros_clock import RosClock

SENDING, STOPPING_ROBOTS = 0.5, 1.5
"""Seconds that closing waits until the last messages have arrived, and those that stop robots; a dead receiver acknowledges
nothing."""
AGAIN = 0.02
"""Seconds between two attempts to deliver the last messages."""
STOPPING = 1.0
"""Seconds that closing waits for each of rclpy's threads."""
AFTER_FAULT = 0.05
"""Pause in seconds after a fault: a recurring one must not use a whole core."""
LINGERING, LINGERING_LONGEST = 0.5, 4.0
"""Minimum and maximum number of seconds that a closed entity stays in the graph while its last message may be on its way.
Until version 2.14.5 of Fast DDS, receivers learn only every 3 s that a message was lost.
"""


class Ros2Node(Backend):
    """The base of publishers, services and actions of the ROS 2 backend.

    Args:
        settings: names, clock and log.
        domain_id: the DDS domain; default: ``ROS_DOMAIN_ID``.
    """

    name = "ros2"

    def __init__(self, settings: NodeSettings, domain_id: int | None = None) -> None:
        self.schema = RosidlSchema()
        super().__init__(settings, self.schema, Lifetime(settings.log, self._leave, True, self._send_rest))
        self._domain_id = domain_id
        # As for every node that uses simulated time: tools query it.
        self._simulated = {"use_sim_time": True} if isinstance(settings.clock, RosClock) else {}
        self._context: Any = rclpy.Context()
        self._executor: Any = None
        self._thread: threading.Thread | None = None
        self._stopped = threading.Event()
        self.ended = False
        """Whether the node has left the graph, or is about to."""
        self._reported = ""
        self.rcl: Any = None
        self.receiver: Receiver
        self._liveness_checks: list[LivenessCheck] = []
        self.unsent: dict[Callable[[], bool], float] = {}
        """Functions that deliver again what was lost, and return whether all messages have arrived; on any thread. The end
        of the node waits for each at most this number of seconds."""
        self._sending_since = 0.0

    async def start(self) -> None:
        """Join the graph."""
        self.join()
        await in_thread(self.loop, self._join, "joining")
        self.found()

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.lifetime.stop()
        if not self.ended:
            self.close_actions()
        await in_thread(self.loop, self._send_rest, "closing")
        self.close_members()  # on the loop: callers that wait for their answers fail here
        await self.lifetime.leave()
        self.left()

    def destroy_entity(self, destroy: Callable[[Any], Any], thing: Any) -> None:
        """Call *destroy* with *thing* on the executor's thread.

        Elsewhere the executor may be about to wait for it, or be iterating over its lists.
        """

        def now() -> None:
            with suppress(Exception):  # it may already be destroyed with its node
                destroy(thing)

        if self.ended or self._executor is None:
            now()
        else:
            self._executor.create_task(now)

    def destroy_entity_later(
        self, destroy: Callable[[Any], Any], thing: Any, sent: Callable[[], bool] = lambda: True
    ) -> None:
        """As `destroy_entity`, after the last messages have arrived according to *sent*, see `unsent`.

        The middleware drops what a destroyed entity has sent if the receiver has not taken it or asks for it again.
        """
        began = time.monotonic()

        def look() -> None:
            waited = time.monotonic() - began
            if self.ended or (_arrived(sent) and waited >= LINGERING) or waited >= LINGERING_LONGEST:
                self.unsent.pop(sent, None)
                self.destroy_entity(destroy, thing)
            else:
                self.loop.call_later(AGAIN, look)

        look()

    def check_liveness(self, find: Find, suspects: frozenset[bytes], report: ReportLost) -> None:
        """Find out which of the *suspects* are alive; see `LivenessCheck.ask`."""
        if self.ended:
            return
        look = next((look for look in self._liveness_checks if look.fresh), None)
        if look is None:
            look = LivenessCheck(self.loop, self._domain_id, self._liveness_checks.remove)
            self._liveness_checks.append(look)
        look.ask(find, suspects, report)

    def _join(self) -> None:
        leave_standard_output_alone()
        # We handle signals: rclpy's handlers would shut the context down before the exit hooks have published.
        no_signals = rclpy.signals.SignalHandlerOptions.NO
        rclpy.init(
            args=[], context=self._context, domain_id=self._domain_id, signal_handler_options=no_signals
        )
        try:
            self.rcl = rclpy.create_node(
                self.names.node_name,
                namespace=self.names.namespace or "/",
                context=self._context,
                use_global_arguments=False,
                # Values for rclpy's own parameters; ours get their values when they are declared.
                parameter_overrides=[
                    parameter(name, value)
                    for name, value in (self._simulated | self.given_parameters).items()
                ],
            )
        except ParameterException as problem:  # a value for one of rclpy's own parameters
            self._context.try_shutdown()
            raise ParameterRefused(f"a parameter of {self.node_name}: {problem}") from None
        for name in self.rcl.list_parameters([], 0).names:  # rclpy's own parameters
            self.given_parameters.take(name)
        self._executor = rclpy.executors.SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.rcl)
        self.receiver = Receiver(self._context, self._report, self._executor)
        # The messages of ``/clock`` that rclpy uses (`use_sim_time`); simulators may send a thousand a second.
        for subscription in self.rcl.subscriptions:
            self.receiver.add(subscription, subscription.callback)
        self._thread = threading.Thread(target=self._spin, name="rclpy executor", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        while self._context.ok() and not self._stopped.is_set():
            try:
                # Not `spin_until_future_complete`: on Jazzy it adds a callback to the future in each turn.
                self._executor.spin_once()
            except rclpy.executors.ExternalShutdownException:
                return
            except Exception as problem:  # an exception in one callback must not block the node
                if self._context.ok():
                    self._report(f"rclpy: {type(problem).__name__}: {problem}")
                    time.sleep(AFTER_FAULT)

    def _report(self, text: str) -> None:
        """Log a fault, in any thread; consecutive equal faults are logged once."""
        if text != self._reported:
            self._reported = text
            post(self.loop, self.log, text)

    def _leave(self) -> None:
        """Wait until the last messages have arrived, then shut rclpy down before the interpreter ends; on any
        thread."""
        if self.rcl is None:
            return
        self._send_rest()
        for look in list(self._liveness_checks):
            look.leave()
        self.receiver.stop(STOPPING)
        # The executor's thread stops itself: shutting down an executor while its thread spins is a race.
        self._executor.create_task(self._stopped.set)
        if self._thread is not None:
            self._thread.join(STOPPING)
        self.ended = True
        self._executor.shutdown(timeout_sec=0.0)
        self.rcl.destroy_node()
        self._context.try_shutdown()

    def _send_rest(self) -> None:
        """Deliver the last messages again and again until they have arrived, on any thread."""
        if self.rcl is None:
            return
        self._sending_since = self._sending_since or time.monotonic()
        arrived = [False]
        while not all(arrived):
            waited = time.monotonic() - self._sending_since
            arrived = [_arrived(sent) or waited > longest for sent, longest in list(self.unsent.items())]
            time.sleep(AGAIN)  # best-effort messages are never acknowledged


def _arrived(sent: Callable[[], bool]) -> bool:
    try:
        return sent()
    except Exception:  # destroyed meanwhile; a failure of one must not affect the others
        return True


PROFILES = "FASTRTPS_DEFAULT_PROFILES_FILE"
"""Names the settings file of Fast DDS 2; version 3 uses another variable and logs to standard error anyway."""

LOGGERS = "RCUTILS_LOGGING_USE_STDOUT"
"""Whether rclpy's loggers write to standard output."""


def leave_standard_output_alone() -> None:
    """Make Fast DDS 2 and rclpy's loggers use standard error, before they start.

    A Fast DDS settings file of the user is kept.
    """
    os.environ[LOGGERS] = "0"
    middleware = os.environ.get("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp")
    if middleware.startswith("rmw_fastrtps") and PROFILES not in os.environ and _is_fast_dds_2():
        os.environ[PROFILES] = str(Path(__file__).with_name("fastdds_log.xml"))


def _is_fast_dds_2() -> bool:
    # The package was renamed to fastdds in version 3.
    if find_spec("fastrtps") is not None:  # pip wheels
        return True
    try:
        import_module("ament_index_python.packages").get_package_prefix("fastrtps")
    except (ImportError, LookupError, OSError, ValueError):
        return False
    return True
