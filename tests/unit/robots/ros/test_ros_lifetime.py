"""The end of a process: zero velocity is the last message, for every way in which a program stops."""

import asyncio
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

from jacaros.robots.ros import lifetime as module
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import WallClock

POSIX = pytest.mark.skipif(
    sys.platform == "win32", reason="os.kill of Windows ends a process without a handler"
)


PROGRAM = """
import asyncio, os, signal, sys, threading, time
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.lifetime import Lifetime

def say(text):
    os.write(1, (text + "\\n").encode())  # threads must not write into each other's lines

threaded = {threaded}
lifetime = Lifetime(say, lambda: say("sent"), threaded)
main_thread = threading.main_thread()

def hook():
    where = "loop" if threading.current_thread() is main_thread else "thread"
    say(f"zero {{lifetime.admits()}} {{where}}")

lifetime.add(hook)

async def main():
    lifetime.join()
    {body}

try:
    run(main, WallClock())
finally:
    say("finally")
"""


OWN_HANDLER = """ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, lambda: (lifetime.stop(), ended.set()))
    os.kill(os.getpid(), signal.SIGTERM)
    await ended.wait()"""


def run_program(body: str, threaded: bool, *options: str, before: str = "") -> tuple[int, list[str]]:
    code = before + PROGRAM.format(threaded=threaded, body=body)
    command = [sys.executable, *options, "-c", code]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=60, check=False)
    return done.returncode, done.stdout.decode().splitlines()


@POSIX
@pytest.mark.parametrize("threaded", [False, True])
@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("pass", 0),
        ("raise ValueError", 1),
        ("sys.exit(5)", 5),
        ("os.kill(os.getpid(), signal.SIGTERM); await asyncio.Event().wait()", 143),
        ("os.kill(os.getpid(), signal.SIGHUP); await asyncio.Event().wait()", 129),
        ("os.kill(os.getpid(), signal.SIGINT); await asyncio.Event().wait()", -2),
        ("os.kill(os.getpid(), signal.SIGTERM)\n    while True: pass", 143),
        ("await lifetime.leave(); os.kill(os.getpid(), signal.SIGTERM)", -15),
        (OWN_HANDLER, 0),
    ],
)
def test_the_robots_stop_before_the_node_leaves_however_the_program_ends(
    body: str, code: int, threaded: bool
) -> None:
    exit_code, lines = run_program(body, threaded)
    assert exit_code == code
    zeros = [line for line in lines if line.startswith("zero True")]
    assert zeros
    if threaded or "leave" not in body:
        assert lines.count("sent") == 1
        assert lines.index(zeros[0]) < lines.index("sent")


@POSIX
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM", "SIGHUP"])
@pytest.mark.parametrize("options", [(), ("-X", "dev")])
def test_hooks_run_on_the_loop_while_it_has_turns(number: str, options: tuple[str, ...]) -> None:
    """Also in asyncio's debug mode, which -X dev switches on."""
    body = f"os.kill(os.getpid(), signal.{number}); await asyncio.sleep(0); await lifetime.leave()"
    _, lines = run_program(body, True, *options)
    assert lines[0] == "zero True loop"
    assert "zero True thread" not in lines


@POSIX
def test_a_stuck_loop_leaves_the_hooks_to_a_thread() -> None:
    body = """try:
        os.kill(os.getpid(), signal.SIGTERM)
    except SystemExit:
        while lifetime._stopped.empty(): pass
        say("stuck until here")"""
    _, lines = run_program(body, True)
    assert lines[:2] == ["zero True thread", "stuck until here"]


@POSIX
def test_the_last_messages_are_delivered_soon_after_a_signal_however_long_closing_takes() -> None:
    body = """delivered = asyncio.Event()
    loop = asyncio.get_running_loop()
    lifetime._insist = lambda: (say("delivered"), loop.call_soon_threadsafe(delivered.set))
    try:
        os.kill(os.getpid(), signal.SIGTERM)
    except SystemExit:
        pass
    await delivered.wait()  # closing has not begun
    await lifetime.leave()"""
    code, lines = run_program(body, True)
    assert code == 0
    assert lines.index("zero True loop") < lines.index("delivered") < lines.index("sent")


def test_a_thread_that_never_ends_keeps_no_hook_back() -> None:
    body = "threading.Thread(target=threading.Event().wait).start(); say('begin'); raise ValueError"
    command = [sys.executable, "-c", PROGRAM.format(threaded=True, body=body)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        assert process.stdout is not None
        lines = [process.stdout.readline().decode().strip() for _ in range(4)]
        process.kill()
    assert lines == ["begin", "finally", "zero True thread", "sent"]


@POSIX
def test_an_ignored_signal_stays_ignored() -> None:
    ignore = "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
    body = "say(str(signal.getsignal(signal.SIGHUP) is signal.SIG_IGN))"
    assert run_program(body, False, before=ignore)[1][0] == "True"


@pytest.fixture
def process(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the process watches, without what other tests have left open."""
    monkeypatch.setattr(module, "_process", module._Process())


@pytest.mark.usefixtures("process")
def test_handlers_are_given_back() -> None:
    before = [signal.getsignal(number) for number in module.SIGNALS]

    lifetime = Lifetime(print)
    remove = lifetime.add(lambda: None)
    assert signal.getsignal(signal.SIGTERM) != before[1]
    remove()
    lifetime.leave_now()
    assert [signal.getsignal(number) for number in module.SIGNALS] == before


@pytest.mark.usefixtures("process")
def test_a_run_takes_signals_although_another_handler_has_replaced_ours() -> None:
    before = signal.getsignal(signal.SIGTERM)
    lifetime = Lifetime(print)
    lifetime.add(lambda: None)
    signal.signal(signal.SIGTERM, before)
    served: list[int] = []
    with module.serving(lambda number, frame: served.append(number)):
        signal.raise_signal(signal.SIGTERM)
    assert served == [signal.SIGTERM]
    lifetime.leave_now()
    signal.signal(signal.SIGTERM, before)


class Wire:
    """What a robot is sent.

    Args:
        interrupting: called in the middle of each message but those of hooks, after it has been admitted.
    """

    def __init__(self, interrupting: Any = lambda lifetime: None, threaded: bool = True) -> None:
        self.sent: list[float] = []
        self.lifetime = Lifetime(print, threaded=threaded)
        self.lifetime.add(lambda: self.publish(0.0))
        self._interrupting = interrupting

    def publish(self, velocity: float) -> None:
        def send(value: float) -> None:
            if value:
                self._interrupting(self.lifetime)
            self.sent.append(value)

        self.lifetime.send(send, velocity)


def stop_in_thread(lifetime: Lifetime) -> None:
    thread = threading.Thread(target=lifetime.stop)
    thread.start()
    thread.join()


@pytest.mark.usefixtures("process")
@pytest.mark.parametrize("threaded", [True, False])
@pytest.mark.parametrize("stop", [Lifetime.stop, stop_in_thread], ids=["here", "in another thread"])
def test_zero_follows_a_velocity_that_was_on_its_way_when_the_robots_stopped(
    stop: Any, threaded: bool
) -> None:
    wire = Wire(stop, threaded)
    wire.publish(0.3)
    assert wire.sent == [0.0, 0.3, 0.0]
    wire.publish(0.3)
    assert wire.sent[-1] == 0.0
    wire.lifetime.leave_now()


@pytest.mark.usefixtures("process")
def test_zero_follows_a_message_that_an_exception_interrupted() -> None:
    def interrupt(lifetime: Lifetime) -> None:
        lifetime.stop()
        wire.sent.append(0.3)
        raise KeyboardInterrupt

    wire = Wire(interrupt)
    with pytest.raises(KeyboardInterrupt):
        wire.publish(0.3)
    assert wire.sent[-1] == 0.0
    wire.lifetime.leave_now()


@pytest.mark.usefixtures("process")
async def test_the_last_message_is_sent_once_more_before_the_node_leaves() -> None:
    wire = Wire()
    wire.lifetime.join()
    wire.lifetime.stop()
    await wire.lifetime.leave()
    assert wire.sent == [0.0, 0.0]
    wire.lifetime.stop()
    assert wire.sent == [0.0, 0.0], "a node that has left publishes nothing"


@pytest.mark.usefixtures("process")
async def test_a_closed_node_leaves_no_thread_behind() -> None:
    before = set(threading.enumerate())
    lifetimes = [Lifetime(print, threaded=True) for _ in range(3)]
    for each in lifetimes:
        each.join()
    [thread] = set(threading.enumerate()) - before
    for each in lifetimes:
        await each.leave()
    thread.join(10)
    assert not thread.is_alive()


@pytest.mark.usefixtures("process")
def test_a_thread_stops_only_what_the_loop_should_have_stopped() -> None:
    first, second = Lifetime(print, threaded=True), Lifetime(print, threaded=True)
    first._reported = True
    first.stop_if_late(0.0)
    second.stop_if_late(0.0)
    assert (first.leaving, second.leaving) == (True, False)


async def test_goals_under_way_are_cancelled_when_the_process_ends() -> None:
    count = "jacaros_interfaces/action/Count"
    graph_node: Any = open_backend("memory", WallClock(), "robot")
    await graph_node.start()
    agents: Any = open_backend("memory", WallClock(), "agents", graph=graph_node.graph)
    await agents.start()
    cancelled = asyncio.Event()

    async def execute(goal: Any) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            cancelled.set()

    graph_node.action_server("/count", count, execute)
    client = agents.action_client("/count", count)
    handle = await client.send(None, None, 5.0)
    agents.lifetime.stop()
    await asyncio.wait_for(cancelled.wait(), 5)
    assert (await handle.outcome(5.0)).status == "canceled", "the client is not closed by the hook"
    hooks = len(agents.lifetime._hooks)
    client.close()
    assert len(agents.lifetime._hooks) == hooks - 1
    await agents.close()
    await graph_node.close()


def test_an_exception_in_the_middle_of_stopping_does_not_block_the_end() -> None:
    """A second signal is raised wherever the first one's work is: here after each of its steps in turn."""
    steps, interrupted = 0, True
    while interrupted:
        steps += 1
        lifetime = Lifetime(lambda line: None)
        interrupted = _interrupt_after(steps, lifetime.stop)
        ending = threading.Thread(target=lifetime.leave_now, daemon=True)
        ending.start()
        ending.join(10.0)
        assert not ending.is_alive(), f"interrupted after {steps} steps"
    assert steps > 5


@pytest.mark.usefixtures("process")
def test_a_robot_stops_although_its_artifact_is_disposed_while_a_thread_stops_the_robots() -> None:
    """The loop disposes the artifact after each of that thread's steps in turn."""
    steps, overtaken = 0, True
    while overtaken:
        steps += 1
        overtaken, sent = _dispose_after(steps)
        assert len(sent) > 1
        assert sent[-1] == 0.0, f"disposed after {steps} steps"
    assert steps > 5


def _dispose_after(steps: int) -> tuple[bool, list[float]]:
    """Stop a robot, dispose of its artifact in another thread after *steps* of that; see `_after`, and what was sent."""
    sent: list[float] = []
    open_publisher = True
    lifetime = Lifetime(print, threaded=True)

    def publish(velocity: float) -> None:
        if open_publisher:
            lifetime.send(sent.append, velocity)

    def dispose() -> None:
        nonlocal open_publisher
        publish(0.0)
        remove()
        open_publisher = False

    def dispose_on_the_loop() -> None:
        loop = threading.Thread(target=dispose)
        loop.start()
        loop.join()

    remove = lifetime.add(lambda: publish(0.0))
    publish(0.3)
    overtaken = _after(steps, lifetime.stop, dispose_on_the_loop)
    lifetime.leave_now()
    return overtaken, sent


def _interrupt_after(steps: int, call: Callable[[], None]) -> bool:
    """Whether *call* was still under way after *steps* events of a trace, where it is interrupted."""

    def interrupt() -> None:
        raise KeyboardInterrupt

    try:
        return _after(steps, call, interrupt)
    except KeyboardInterrupt:
        return True


def _after(steps: int, call: Callable[[], None], intervene: Callable[[], None]) -> bool:
    """Whether *call* was still under way after *steps* events of a trace, when *intervene* is called."""
    seen = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal seen
        seen += 1
        if seen == steps:
            intervene()
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        call()
    finally:
        sys.settrace(before)
    return seen >= steps


def test_a_hook_that_is_removed_while_the_node_leaves_stops_its_robot_once_more() -> None:
    sent: list[str] = []
    lifetime = Lifetime(sent.append)
    remove = lifetime.add(lambda: sent.append("zero"))
    lifetime.stop()
    sent.clear()  # as if the velocity of another thread had followed
    remove()
    assert sent == ["zero"]
    remove()
    assert sent == ["zero"]
    lifetime.left()
