"""Programs of the experiment that read the system's time, wait and pause: on the virtual clock."""

import datetime
import sys
import threading
import time
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.runtime.clock import VIRTUAL_EPOCH
from jacaros.testing import RunResult

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from scenarios import SCENARIOS
from virtual_run import run_baseline

NODE = """
import datetime, queue, threading, time
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("node")
log = node.get_logger().info
began = time.monotonic()

def note(what):
    log(f"{what} {time.monotonic() - began:.2f}")
"""


@pytest.fixture
def run(tmp_path: Path):
    def run(text: str, seconds: float = 60.0) -> RunResult:
        program = tmp_path / "program.py"
        program.write_text(NODE + text, encoding="utf-8")
        return run_baseline(SCENARIOS["fake_battery"]._replace(baseline=program), seconds=seconds)

    return run


def said(result: RunResult) -> list[str]:
    assert result.errors == []
    return [line.removeprefix("[node] ") for line in result.lines]


@pytest.mark.parametrize(
    ("wait", "seconds"),
    [
        ("time.sleep(2.5)", 2.5),
        ("threading.Event().wait(2.5)", 2.5),
        ("threading.Semaphore(0).acquire(timeout=2.5)", 2.5),
        ("queue.Queue().put(1, timeout=2.5)", 0.0),
        ("event = threading.Event(); threading.Timer(1.5, event.set).start(); event.wait(9)", 1.5),
    ],
)
def test_a_program_waits_on_the_virtual_clock(run, wait: str, seconds: float) -> None:
    assert said(
        run(f"threading.Thread(target=rclpy.spin, args=(node,)).start()\n{wait}\nnote('waited')")
    ) == [f"waited {seconds:.2f}"]


def test_an_empty_queue_is_waited_for_until_the_timeout(run) -> None:
    text = "try:\n    queue.Queue().get(timeout=2)\nexcept queue.Empty:\n    note('empty')"
    assert said(run(text)) == ["empty 2.00"]


def test_all_clocks_of_the_system_show_the_virtual_time(run) -> None:
    clocks = "time.time(), datetime.datetime.now(datetime.UTC).timestamp(), time.time_ns() / 1e9"
    result = run(f"time.sleep(7)\nlog(repr([round(t) for t in ({clocks})]))\nlog(str(time.perf_counter()))")
    assert said(result) == [str([round(VIRTUAL_EPOCH) + 7] * 3), "7.0"]


def test_a_datetime_made_elsewhere_is_still_a_datetime(run) -> None:
    assert said(run("log(str(isinstance(datetime.datetime.min, datetime.datetime)))")) == ["True"]


def test_callbacks_are_held_while_one_waits_and_a_timer_rings_once_for_the_time_missed(run) -> None:
    text = """
def slow():
    note("begins")
    time.sleep(3)
    note("ends")
    raise SystemExit
node.create_timer(0.95, slow)
node.create_timer(0.5, lambda: note("tick"))
rclpy.spin(node)
"""
    assert said(run(text)) == ["tick 0.50", "begins 0.95", "ends 3.95"]
    assert said(run(text.replace("    raise SystemExit\n", ""), 3.99))[3:] == ["tick 3.95", "begins 3.95"]


def test_an_event_of_a_callback_ends_the_wait_of_a_program_whose_thread_spins(run) -> None:
    text = """
arrived = threading.Event()
node.create_timer(1.25, arrived.set)
if not arrived.wait(3):
    note("nothing spins")
threading.Thread(target=rclpy.spin, args=(node,)).start()
arrived.wait()
note("arrived")
"""
    assert said(run(text)) == ["nothing spins 3.00", "arrived 3.00"]


def test_a_thread_that_does_not_spin_is_refused(run) -> None:
    [error] = run("threading.Thread(target=print, name='worker').start()").errors
    assert "thread worker: on the virtual clock a thread can only spin a node\n  = help: use a timer" in error


TREE = """
import py_trees
pause = py_trees.timers.Timer("Pause", 2.0)
never = py_trees.behaviours.Running("Never")
timeout = py_trees.decorators.Timeout("Limit", never, 2.0)

def tick(behaviour, end):
    behaviour.tick_once()
    if behaviour.status == end:
        note(behaviour.name)
        raise SystemExit
"""


@pytest.mark.parametrize(("behaviour", "end"), [("pause", "SUCCESS"), ("timeout", "FAILURE")])
def test_timers_and_timeouts_of_py_trees_last_two_virtual_seconds(run, behaviour: str, end: str) -> None:
    began = time.monotonic()
    tick = f"tick({behaviour}, py_trees.common.Status.{end})"
    [line] = said(run(f"{TREE}node.create_timer(0.1, lambda: {tick})\nrclpy.spin(node)"))
    assert float(line.split()[1]) == pytest.approx(
        2.15, abs=0.06
    )  # from the first tick to the next after the end
    assert time.monotonic() - began < 30


def test_a_program_that_never_ends_is_ended_wherever_it_waits(run) -> None:
    result = run("while True:\n    time.sleep(1)", seconds=5)
    assert (result.seconds, result.exit_code, result.errors) == (5.0, 0, [])


def test_the_genuine_time_is_back_after_a_run_and_other_threads_never_lose_it(run) -> None:
    genuine = (time.time, time.monotonic, time.sleep, threading.Condition.wait, threading.Thread.start)
    genuine_datetime = datetime.datetime
    seen: list[float] = []
    done = threading.Event()

    def watch() -> None:
        while not done.wait(0.001):
            seen.append(time.time())

    thread = threading.Thread(target=watch)
    thread.start()
    run("time.sleep(30)")
    done.set()
    thread.join()
    assert min(seen) > VIRTUAL_EPOCH + 1e8
    assert genuine == (
        time.time,
        time.monotonic,
        time.sleep,
        threading.Condition.wait,
        threading.Thread.start,
    )
    assert datetime.datetime is genuine_datetime


def test_a_module_that_kept_a_function_works_after_the_run_and_in_the_next(run, monkeypatch) -> None:
    for _ in range(2):
        result = run("import sys\nsys.kept = getattr(sys, 'kept', time.time)\nlog(str(round(sys.kept())))")
        assert said(result) == [str(round(VIRTUAL_EPOCH))]
    monkeypatch.delattr(sys, "kept")
