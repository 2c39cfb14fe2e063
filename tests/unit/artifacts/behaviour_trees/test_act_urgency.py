"""``Act(..., urgency=N)``: a tree takes the wheels from a less urgent operation, which continues afterwards."""

import asyncio

import pytest
from py_trees.common import Status

from jacaros.artifacts import Artifact, operation
from jacaros.artifacts.behaviour_trees import Act, PropertyCheck


class Wheels(Artifact):
    """A base that drives a metre a second and can pause after each metre; it notes what it does, and when."""

    def init(self) -> None:
        self.lines: list[str] = []

    @operation(uses="wheels", pausable=True)
    async def drive(self, name: str, metres: int) -> None:
        """Drive."""
        for done in range(metres):
            await self.pause_point()
            await self.sleep(1.0)
            self.lines.append(f"{self.clock.elapsed:g} {name} {done + 1}")


@pytest.fixture
def two_drive(on_rails):
    """Drive 3 m for another session, and 2 m by a tree from 0.5 s on; return what the base noted."""

    def play(urgency, urgency_of_other=0):
        async def scene(rails):
            base = await rails.other.make_artifact("base", Wheels)
            tour = rails.other.begin("drive", "tour", 3, artifact=base, urgency=urgency_of_other)
            await rails.clock.sleep(0.5)
            flee = Act("drive", "flee", 2, artifact=base, urgency=urgency)
            assert await rails.runner(flee).run() is Status.SUCCESS
            await tour
            assert not rails.environment.arbiter.holders("wheels")
            return rails.environment.artifact(base).lines

        return on_rails(scene)

    return play


def test_a_more_urgent_act_takes_the_wheels_and_the_other_operation_continues(two_drive):
    assert two_drive(urgency=10) == ["1 tour 1", "2 flee 1", "3 flee 2", "4 tour 2", "5 tour 3"]


@pytest.mark.parametrize(("urgency", "urgency_of_other"), [(0, 0), (5, 5), (1, 10)])
def test_an_act_that_is_not_more_urgent_waits(two_drive, urgency, urgency_of_other):
    assert two_drive(urgency, urgency_of_other) == [
        "1 tour 1",
        "2 tour 2",
        "3 tour 3",
        "4 flee 1",
        "5 flee 2",
    ]


async def test_an_act_is_preempted_and_keeps_running_until_it_has_the_wheels_again(rails):
    base = await rails.other.make_artifact("base", Wheels)
    tour = Act("drive", "tour", 3, artifact=base)
    running = asyncio.ensure_future(rails.runner(tour).run())
    await rails.clock.sleep(0.5)
    await rails.other.act("drive", "flee", 2, artifact=base, urgency=10)
    assert tour.status is Status.RUNNING
    assert await running is Status.SUCCESS
    assert rails.environment.artifact(base).lines == [
        "1 tour 1",
        "2 flee 1",
        "3 flee 2",
        "4 tour 2",
        "5 tour 3",
    ]


async def test_an_interrupted_act_gives_the_wheels_back(rails, reactive):
    base = await rails.other.make_artifact("base", Wheels)
    tour = rails.other.begin("drive", "tour", 3, artifact=base)
    await rails.clock.sleep(0.5)
    flee = Act("drive", "flee", 9, artifact=base, urgency=10)
    root = reactive("sequence", PropertyCheck("battery", lambda level: level > 20), flee)
    status, _ = await asyncio.gather(rails.runner(root).run(), rails.at(2.5, "drain", 10))
    assert status is Status.FAILURE
    await tour
    lines = rails.environment.artifact(base).lines
    assert [line.split(" ", 1)[1] for line in lines] == ["tour 1", "flee 1", "tour 2", "tour 3"]
    assert rails.clock.elapsed == pytest.approx(4.5, abs=0.02)
