"""Claims of a robot's wheels: no wake-up is lost, lateness and steps of the clock of more than half a second are gaps, and
all that drive or wait can be aborted."""

import asyncio

import pytest

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.artifacts.driving import MotionClaim, Motions, motions_of
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.ros_clock import RosClock
from jacaros.runtime.clock import VirtualClock, run


class Scene:
    """A claim that waits for a second, while the clock can be made late or be set."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.stops = 0
        self.claim = MotionClaim(self.stop)

    def stop(self) -> None:
        self.stops += 1

    def wait(self, late: float = 0.0, step: float = 0.0, seconds: float | None = 1.0) -> None:
        async def main() -> None:
            waiting = asyncio.ensure_future(self.claim.wait(self.clock, seconds))
            await asyncio.sleep(0)
            self.clock.start += step
            if late:
                self.clock.busy(round((1.0 + late) * 1000) * VirtualClock.CYCLES_PER_MILLISECOND)
            if seconds is None:
                self.claim.wake()
            await waiting

        run(main, self.clock)


@pytest.mark.parametrize("late", [0.0, 0.4])
@pytest.mark.parametrize("step", [0.0, 0.4, -0.4])
def test_half_a_second_is_not_a_gap(late: float, step: float) -> None:
    scene = Scene()
    scene.wait(late, step)
    assert scene.claim.gap is None
    assert scene.stops == 0


def test_a_late_wake_up_is_a_gap_and_stops_the_robot() -> None:
    scene = Scene()
    scene.wait(late=0.8)
    assert scene.claim.gap == Structure("delayed", (0.8,))
    assert scene.stops == 1


@pytest.mark.parametrize("step", [0.8, -0.8])
def test_a_step_of_the_clock_either_way_is_a_gap_and_stops_the_robot(step: float) -> None:
    scene = Scene()
    scene.wait(step=step)
    assert scene.claim.gap == Structure("clock_jumped", (step,))
    assert scene.stops == 1


def test_a_wait_without_a_time_has_no_gap() -> None:
    scene = Scene()
    scene.wait(late=3.0, step=5.0, seconds=None)
    assert scene.claim.gap is None


def test_an_interruption_stops_the_robot_and_keeps_the_reason() -> None:
    scene = Scene()
    scene.claim.interrupt(Atom("guard_tripped"))
    assert scene.claim.gap == Atom("guard_tripped")
    assert not scene.claim.aborted
    scene.wait()
    assert scene.clock.elapsed == 0.0, "the interruption ends the next wait"
    assert scene.stops == 1


def test_wake_ups_before_and_during_a_wait_end_it_once() -> None:
    scene = Scene()

    async def main() -> None:
        scene.claim.wake()
        await scene.claim.wait(scene.clock, None)
        waiting = asyncio.ensure_future(scene.claim.wait(scene.clock, 5.0))
        await asyncio.sleep(0)
        scene.claim.wake()
        scene.claim.wake()
        await waiting
        assert scene.clock.elapsed == 0.0
        await scene.claim.wait(scene.clock, 1.0)
        assert scene.clock.elapsed == 1.0
        assert not scene.clock.pending()

    run(main, scene.clock)
    assert scene.claim.gap is None


async def test_the_first_message_of_clock_does_not_count_as_a_jump() -> None:
    clock = RosClock(lambda text: None)
    stopped: list[bool] = []
    claim = MotionClaim(lambda: stopped.append(True))
    for time, gap in ((1000.0, None), (990.0, Structure("clock_jumped", (-10.0,)))):
        waiting = asyncio.ensure_future(claim.wait(clock, 60.0))
        await asyncio.sleep(0)
        clock.move_to(time)
        claim.wake()
        await waiting
        assert claim.gap == gap
    assert stopped == [True]


def test_abort_stops_and_wakes_all_motions() -> None:
    stopped = []
    motions = Motions()
    tickets = [MotionClaim(lambda number=number: stopped.append(number)) for number in range(3)]  # type: ignore[misc]
    for each in tickets[:2]:
        motions.claims[each] = None
    motions.abort()
    assert stopped == [0, 1]
    assert motions.stops == 1
    assert [each.aborted for each in tickets] == [True, True, False]


def test_the_motions_of_a_robot_of_a_backend_are_kept_together() -> None:
    clock = VirtualClock()

    async def main() -> None:
        one, other = (open_backend("memory", clock, name) for name in ("one", "other"))
        assert motions_of(one, "/r") is motions_of(one, "/r")
        assert motions_of(one, "/r") is not motions_of(one, "")
        assert motions_of(one, "/r") is not motions_of(other, "/r")

    run(main, clock)
