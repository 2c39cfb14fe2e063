"""``TreeRunner``: when a tree is ticked, and how it ends."""

import asyncio
import subprocess
import sys
import time

import py_trees
import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence
from py_trees.decorators import FailureIsRunning

from jacaros.artifacts import WorkspaceError
from jacaros.artifacts.behaviour_trees import (
    Act,
    ArtifactBehaviour,
    PropertyCheck,
    TreeRunner,
)


class Wrong(Behaviour):
    """Raises when it is ticked, or at its end."""

    def __init__(self, ticks=1, ends_badly=False):
        super().__init__("wrong")
        self.ticks, self.ends_badly = ticks, ends_badly

    def update(self):
        self.ticks -= 1
        if self.ticks <= 0:
            raise RuntimeError("a mistake in a behaviour")
        return Status.RUNNING

    def terminate(self, new_status):
        if self.ends_badly:
            raise RuntimeError("a mistake at its end")


async def test_it_ticks_at_its_period(rails):
    await rails.runner(py_trees.timers.Timer("rest", 0.5), period=0.2).run()
    assert rails.ticks == [0, 0.2, 0.4, 0.6]


async def test_without_a_period_it_ticks_only_when_something_happens(rails):
    await rails.runner(Act("drive", 3), period=None).run()
    # The cart begins to move, and shows each metre; its last metre and the end of the operation are one tick.
    assert rails.ticks == [0, 0.01, 1.0, 2.0, 3.0]


async def test_what_comes_together_is_one_tick(rails):
    async def changes():
        await rails.clock.sleep(1)
        for level in (90, 80, 70):
            await rails.other.act("drain", level)

    wait = FailureIsRunning("low", PropertyCheck("battery", lambda level: level < 75))
    await asyncio.gather(rails.runner(wait, period=None).run(), changes())
    assert rails.ticks == [0, 1.0]


async def test_a_tree_woken_by_its_own_operations_does_not_block_virtual_time(rails):
    runner = rails.runner(Act("drain", 1), period=None)
    runner.tree.add_post_tick_handler(lambda tree: tree.count == 100 and runner.stop())
    await runner.run(forever=True)
    assert rails.clock.elapsed == pytest.approx(1.0)


async def test_what_the_tree_itself_changes_does_not_make_its_period_shorter(rails):
    runner = rails.runner(Act("drain", 1), period=0.5)
    runner.tree.add_post_tick_handler(lambda tree: tree.count == 3 and runner.stop())
    await runner.run(forever=True)
    assert rails.ticks == [0, 0.5, 1.0, 1.5]


def test_two_runs_tick_at_the_same_moments(on_rails, reactive):
    async def scene(rails):
        check = PropertyCheck("battery", lambda level: level > 20)
        root = reactive("selector", reactive("sequence", check, Act("drive", 4)), Act("paint", "red"))
        await asyncio.gather(rails.runner(root).run(), rails.at(1.234, "drain", 10))
        return rails.ticks

    assert on_rails(scene) == on_rails(scene)


async def test_the_tree_may_have_visitors_and_handlers(rails):
    tree = py_trees.trees.BehaviourTree(Act("drive", 1))
    visitor = py_trees.visitors.SnapshotVisitor()
    tree.add_visitor(visitor)
    runner = TreeRunner(tree, rails.session)
    assert await runner.run() is Status.SUCCESS
    assert runner.tree is tree
    assert list(visitor.visited.values()) == [Status.SUCCESS]


async def test_a_tree_runs_once_at_a_time_and_can_run_again(rails):
    runner = rails.runner(Act("drive", 2))
    task = asyncio.create_task(runner.run())
    await rails.clock.sleep(1)
    with pytest.raises(RuntimeError, match=r"the tree `drive\(2\)` is already running"):
        await runner.run()
    assert await task is Status.SUCCESS
    assert await runner.run() is Status.SUCCESS
    assert rails.session.value("at") == 4


async def test_a_tree_can_be_ticked_without_a_runner(rails):
    tree = py_trees.trees.BehaviourTree(Act("drive", 2))
    tree.setup(session=rails.session)
    while tree.root.status in (Status.INVALID, Status.RUNNING):
        tree.tick()
        await rails.clock.sleep(0.5)
    assert (tree.root.status, tree.count) == (Status.SUCCESS, 5)


async def test_behaviours_of_others_get_what_they_need(rails):
    class NeedsNode(Wrong):
        def setup(self, **given):
            self.node = given["node"]

    behaviour = NeedsNode(5)
    runner = rails.runner(behaviour, setup={"node": "a node of ROS"})
    rails.clock.call_later(0.15, runner.stop)
    await runner.run()
    assert behaviour.node == "a node of ROS"


async def test_behaviours_of_a_project_use_the_session_and_wake_the_tree(rails):
    class Reaches(ArtifactBehaviour):
        def initialise(self):
            self.seen = []
            self.session.on_change(lambda change: (self.seen.append(change.now), self.wake()))

        def update(self):
            return Status.SUCCESS if (2,) in self.seen else Status.RUNNING

    runner = rails.runner(Reaches("at 2"), period=None)
    await asyncio.gather(runner.run(), rails.at(1, "drive", 4))
    assert rails.ticks[-1] == 3.0


async def test_it_can_be_stopped_from_outside(rails):
    runner = rails.runner(Act("drive", 9), period=None)
    rails.clock.call_later(2.5, runner.stop)
    assert await runner.run() is Status.RUNNING
    await rails.session.until(lambda: rails.session.value("moving") == "stopped")
    assert (rails.session.value("at"), rails.clock.elapsed) == (2, 2.5)


async def test_when_its_task_is_cancelled_the_cart_stops(rails):
    task = asyncio.create_task(rails.runner(Sequence("s", memory=True, children=[Act("drive", 9)])).run())
    await rails.clock.sleep(2.5)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    await rails.session.until(lambda: rails.session.value("moving") == "stopped")
    assert rails.session.value("at") == 2


async def test_an_interrupted_tick_reports_all_running_behaviours(rails):
    class Running(Behaviour):
        ended = None

        def update(self):
            return Status.RUNNING

        def terminate(self, new_status):
            self.ended = new_status

    before = Running("before")
    root = py_trees.composites.Parallel("p", py_trees.common.ParallelPolicy.SuccessOnAll(), [before, Wrong()])
    with pytest.raises(RuntimeError):
        await rails.runner(root).run()
    assert before.ended is Status.INVALID


@pytest.mark.parametrize("ends_badly", [False, True])
async def test_what_a_behaviour_raises_is_raised_and_the_cart_stops(rails, ends_badly):
    children = [Act("drive", 9), Wrong(3, ends_badly)]
    root = py_trees.composites.Parallel("p", py_trees.common.ParallelPolicy.SuccessOnAll(), children)
    with pytest.raises(RuntimeError, match="a mistake"):
        await rails.runner(root).run()
    await rails.session.until(lambda: rails.session.value("moving") == "stopped")
    assert rails.session.value("at") == 0


async def test_a_setup_that_raises_is_raised(rails):
    class Unready(Wrong):
        def setup(self, **given):
            raise RuntimeError("no driver")

    with pytest.raises(RuntimeError, match="no driver"):
        await rails.runner(Unready()).run()


async def test_a_closed_session_is_reported(rails):
    rails.clock.call_later(1.5, rails.session.close)
    with pytest.raises(WorkspaceError, match="session tree has been closed"):
        await rails.runner(Act("drive", 9)).run(forever=True)


@pytest.mark.parametrize("root", [None, Act, "patrol"])
async def test_a_tree_needs_a_root(rails, root):
    with pytest.raises(TypeError, match="expected a root behaviour of py_trees, found"):
        TreeRunner(root, rails.session)


async def test_a_tree_needs_a_session_and_a_positive_period(rails):
    with pytest.raises(TypeError, match=r"found 'driver'; a PythonAgent has one: self\.session"):
        TreeRunner(Act("drive", 1), "driver")
    for period in (0, -1, float("nan")):
        with pytest.raises(ValueError, match="positive number of seconds"):
            TreeRunner(Act("drive", 1), rails.session, period=period)


def test_without_py_trees_the_error_has_help():
    code = "import sys; sys.modules['py_trees'] = None\nimport jacaros.artifacts.behaviour_trees"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr.splitlines()[-1] == (
        "ModuleNotFoundError: behaviour trees need py_trees, which is not installed: "
        "pip install 'jacaros[behaviour-trees]'"
    )


async def test_an_observer_receives_behaviours_and_operations_from_beginning_to_end(rails):
    told = []
    rails.session.observer = lambda state, text, which, why: told.append((state, text, why))
    far = Sequence("tour", memory=True, children=[Act("drive", 3), Act("drive", 30)])
    await rails.runner(
        Selector("whatever", memory=True, children=[far, py_trees.timers.Timer("0.5 s", 0.5)])
    ).run()
    assert [news for news in told if news[0] == "executing"] == [
        ("executing", text, "") for text in ("whatever", "tour", "drive(3)", "drive(30)", "0.5 s")
    ]
    ends = [(state, text) for state, text, _ in told if state != "executing"]
    assert ends[:3] == [("achieved", "drive(3)"), ("failed", "drive(30)"), ("failed", "tour")]
    assert sorted(ends[3:]) == [("achieved", "0.5 s"), ("achieved", "whatever")]
    assert ("failed", "drive(30)", "a wall") in told


async def test_timers_of_py_trees_follow_the_clock_of_the_run(rails):
    rest = py_trees.timers.Timer("rest", 500.0)
    drive = py_trees.decorators.Timeout("at most 2 s", Act("drive", 9), duration=2.0)
    moments = []
    for root in (rest, drive):
        status = await rails.runner(root).run()
        moments.append((status, rails.clock.elapsed))
        assert "update" not in vars(root), "the object is as before the run"
    assert py_trees.timers.time is time
    begun = time.monotonic()
    ends = [(Status.SUCCESS, pytest.approx(500, abs=0.3)), (Status.FAILURE, pytest.approx(502, abs=0.6))]
    assert moments == ends
    assert time.monotonic() - begun < 100


async def test_a_timer_that_cannot_follow_a_virtual_clock_is_refused(rails):
    class Rest(py_trees.timers.Timer):
        def update(self):
            return super().update()

    with pytest.raises(
        TypeError, match=r"`rest` \(Rest\) follows the time of day.*derive it from ArtifactBehaviour"
    ):
        await rails.runner(Rest("rest", 5.0)).run()
    await rails.runner(py_trees.timers.Timer("rest", 1.0)).run()
