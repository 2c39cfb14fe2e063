"""The world as a separate process on a ROS graph, with a ground truth file.

Its time is published on ``/clock``, for nodes in simulated time (ROS's ``use_sim_time``).
"""

import asyncio
import json
import sys
from collections.abc import Callable
from contextlib import AsyncExitStack
from io import FileIO
from pathlib import Path
from types import FrameType, TracebackType

from jacaros.robots.ros import lifetime
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.message import stamp
from jacaros.robots.world.data.ground_truth import JsonRecord, event_record, header
from jacaros.robots.world.node import SimNode
from jacaros.robots.world.physics.world import World
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.output import Output

_FLUSH = 0.2
"""Maximum delay in seconds until a record is in the file."""


class GroundTruthFile:
    """Writes the ground truth of a running world as JSON lines; a line is in the file after at most 0.2 s.

    A context manager; the file ends with an ``end`` record if the world was stopped normally.

    Args:
        path: output file.
        world: the world.
        epoch: the clock's time (seconds) at which the world's time was 0.
        warn: takes a warning that the file cannot be written (default: print it on the standard error output).

    Raises:
        OSError: the file cannot be opened.
    """

    def __init__(
        self, path: str | Path, world: World, epoch: float, warn: Callable[[str], None] | None = None
    ) -> None:
        self._world = world
        self._file = FileIO(path, "w")
        self._output = Output(self._file, str(path), warn or _to_stderr, delay=_FLUSH, raw=True)
        truth = world.ground_truth
        self._write(header(truth.world, world.description.seed, epoch))
        for robot in truth.robots:
            self._write({"kind": "sample", "robot": robot, **truth.latest(robot)._asdict()})
        for event in truth.events:  # faults that started with the world
            self._write(event_record(event))
        self._stop_listening = truth.listen(self._write)

    def _write(self, record: JsonRecord) -> None:
        self._output.write(json.dumps(record) + "\n")

    def __enter__(self) -> "GroundTruthFile":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop_listening()
        truth = self._world.ground_truth
        for robot in truth.robots:
            self._write({"kind": "sample", "robot": robot, **truth.latest(robot)._asdict()})
        if kind is None:
            dirt = {"dirt": [[*where, grams] for where, grams in truth.dirt.items()]} if truth.dirt else {}
            self._write({"kind": "end", "time": self._world.time, **dirt})
        self._output.close()
        self._file.close()


def _to_stderr(text: str) -> None:
    print(f"warning: {text}", file=sys.stderr)


async def serve(
    world: World,
    backend: Backend,
    clock: Clock,
    duration: float | None = None,
    ground_truth_path: str | Path | None = None,
    publish_clock: bool = False,
    when_open: Callable[[], None] | None = None,
) -> None:
    """Run *world* as a separate node until a signal ends it, or for *duration* seconds of the clock.

    Args:
        world: the world.
        backend: backend for this node; it is started and closed here.
        clock: clock that the world follows.
        duration: seconds; None for no limit.
        ground_truth_path: file to write, for `jacaros.robots.world.data.ground_truth.GroundTruth.read`.
        publish_clock: whether to publish *clock* on ``/clock``, for nodes in simulated time.
        when_open: called as soon as the robots have joined the graph.

    Raises:
        OSError: the file cannot be written.
        RosError: the backend rejects a name or a type.
    """
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()

    def end(number: int, frame: FrameType | None) -> None:
        loop.call_soon_threadsafe(stop.set)

    # Not `loop.add_signal_handler`, which Windows does not have.
    with lifetime.serving(end):
        async with AsyncExitStack() as closing:
            closing.push_async_callback(backend.close)
            await backend.start()
            node = SimNode(world, backend, clock)
            closing.callback(node.close)
            node.start()
            if publish_clock:
                closing.callback(ClockPublisher(clock, backend).close)
            if duration is not None:
                closing.callback(clock.call_later(duration, stop.set).cancel)
            if when_open is not None:
                when_open()
            if ground_truth_path is not None:
                closing.enter_context(GroundTruthFile(ground_truth_path, world, node.time.epoch))
                closing.callback(node.stop)
            await stop.wait()


PERIOD = 0.01
"""Seconds of the world between two messages."""


class ClockPublisher:
    """Publishes ``rosgraph_msgs/msg/Clock`` on ``/clock``, 100 times per second.

    Args:
        clock: clock that the world follows.
        backend: graph; already started.
    """

    def __init__(self, clock: Clock, backend: Backend) -> None:
        self._clock = clock
        self._publisher = backend.publisher("/clock", "rosgraph_msgs/msg/Clock")
        self._timer: Timer | None = None
        self._last = 0.0
        self._tick()

    def _tick(self) -> None:
        self._timer = self._clock.call_later(PERIOD, self._tick)
        # This clock must not go back, even if that of the machine does.
        self._last = max(self._last, self._clock.now())
        message = self._publisher.message()
        stamp(message.clock, self._last)
        self._publisher.publish(message)

    def close(self) -> None:
        """Withdraw the topic."""
        if self._timer is not None:
            self._timer.cancel()
        self._publisher.close()
