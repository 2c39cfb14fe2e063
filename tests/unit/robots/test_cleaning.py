"""ArtCleaning: the tasks of each room, in the thesis's words and times."""

import re
from typing import Any

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Environment, Out, Structure
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.robots.artifacts.thesis import ArtCleaning
from jacaros.runtime.clock import VirtualClock, run


def heard(lab: Lab, topic: str = "/cleaning/task") -> list[str]:
    texts: list[str] = []
    lab.backend.subscription(topic, "std_msgs/msg/String", lambda sample: texts.append(sample.message.data))
    return texts


pytestmark = made(ArtCleaning)


async def test_each_room_has_its_tasks_and_takes_its_time(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    tasks, times = heard(lab), []
    for room in range(4):
        begin = lab.clock.elapsed
        await lab.do(artifact, "clean", room)
        times.append(round(lab.clock.elapsed - begin, 6))
    assert times == [2.5, 2.5, 2.5, 3.5]
    assert watcher.changes[4:] == [
        ("vacuum", ("Carpet", "living Room")),
        ("mop", ("Floor", "kitchen")),
        ("scrub", ("Tub", "bathroom")),
        ("mop", ("Floor", "bathroom")),
    ]
    bathroom = ["scrub tub bathroom", "mop floor bathroom"]
    assert tasks == ["vacuum carpet living_room", "mop floor kitchen", *bathroom]
    assert watcher.signals == []


async def test_work_rests_while_the_intention_is_suspended(lab: Lab, artifact: ArtifactId) -> None:
    tasks = heard(lab)
    cleaning = await lab.begun(0.4, artifact, "clean", 3)
    await cleaning.pause(10)
    assert tasks == ["scrub tub bathroom"]
    cleaning.execution.resume()
    await lab.sleep(0.59)
    assert tasks == ["scrub tub bathroom"]
    await lab.sleep(0.02)
    assert tasks == ["scrub tub bathroom", "mop floor bathroom"]
    for _ in range(3):
        await cleaning.pause(0.5)
        cleaning.execution.resume()
        await lab.sleep(0.5)
    await cleaning.done
    assert round(lab.clock.elapsed, 2) == 10 + 3 * 0.5 + 3.5


async def test_a_tool_rests_while_the_intention_is_suspended_and_stops_at_the_end(
    lab: Lab, artifact: ArtifactId
) -> None:
    tools: list[tuple[float, str]] = []
    lab.backend.subscription(
        "/cleaning/tool",
        "std_msgs/msg/String",
        lambda sample: tools.append((round(lab.clock.elapsed, 2), sample.message.data)),
    )
    cleaning = await lab.begun(0.4, artifact, "clean", 3)
    await cleaning.pause(0.1)  # shorter than the sleep that goes on
    cleaning.execution.resume()
    await lab.sleep(2.0)
    await cleaning.pause(10)
    await cleaning.resumed()
    assert tools == [(0.4, ""), (0.5, "scrub"), (2.5, ""), (12.5, "mop"), (13.6, "")]
    dropped = await lab.begun(1, artifact, "clean", 1)
    await dropped.drop(5)
    assert tools[5:] == [(14.6, "")]


async def test_rooms_follow_each_other_and_one_can_ask_where_one_is(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    """Defect 9: programs removed atRoom themselves, without effect; here an update is enough."""
    assert (await lab.call(artifact, "clean", 4)).reason == "unknown_room(4)"
    assert lab.clock.elapsed == 0
    for _ in range(5):
        await lab.do(artifact, "updateWhereAmI")
    assert watcher.values("atRoom") == [(0,), (1,), (2,), (3,), (0,), (1,)]
    assert watcher.holds("atRoom") == [(1,)]
    await lab.do(artifact, "whereAmI")
    assert watcher.values("atRoom")[-2:] == [(1,), (1,)]
    room, name = Out(), Out()
    await lab.do(artifact, "whereAmI", room, name)
    assert (room.value, name.value) == (1, "living Room")


STUDY = Structure("room", ("study", [Structure("vacuum", ("Carpet",)), Structure("mop", ("Floor",))]))


@made(ArtCleaning, Structure("more_rooms", ([STUDY],)))
async def test_a_house_may_have_more_rooms(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    tasks = heard(lab)
    for _ in range(5):
        await lab.do(artifact, "updateWhereAmI")
    assert watcher.values("atRoom") == [(0,), (1,), (2,), (3,), (4,), (0,)]
    await lab.do(artifact, "clean", 4)
    assert tasks == ["vacuum carpet study", "mop floor study"]
    assert watcher.holds("vacuum") == [("Carpet", "study")]
    assert (await lab.call(artifact, "clean", 5)).reason == "unknown_room(5)"


WRONG_ROOMS: list[tuple[object, str]] = [
    (3, "option more_rooms(3): expected a list such as"),
    ([Structure("room", ("study",))], "expected rooms such as"),
    (
        [Structure("room", ("study", [Structure("sweep", ("Floor",))]))],
        "of the kinds vacuum, mop, scrub, found sweep",
    ),
]


@pytest.mark.parametrize(("value", "told"), WRONG_ROOMS)
async def test_wrong_rooms_are_refused(lab: Lab, value: object, told: str) -> None:
    with pytest.raises(OperationFailed, match=re.escape(told)):
        await lab.make(ArtCleaning, Structure("more_rooms", (value,)))


async def test_other_operations_are_served_while_a_room_is_cleaned(lab: Lab) -> None:
    cleaner = await lab.make(ArtCleaning)
    watcher = lab.watch(cleaner)
    cleaning = await lab.begun(0.5, cleaner, "clean", 3)
    await lab.do(cleaner, "updateWhereAmI")
    assert lab.clock.elapsed == 0.5
    assert watcher.holds("scrub") == [("Tub", "bathroom")]
    await cleaning.drop(5)
    assert watcher.holds("mop") == [("", "")], "a dropped cleaning does nothing more"


@pytest.mark.parametrize("argument", ["robot_0", Structure("namespace", ("robot_0",))])
async def test_tasks_go_to_the_topic_of_the_robot(lab: Lab, argument: Any) -> None:
    tasks = heard(lab, "/robot_0/cleaning/task")
    await lab.do(await lab.make(ArtCleaning, argument), "clean", 1)
    assert tasks == ["vacuum carpet living_room"]


def test_it_works_without_ros() -> None:
    async def main() -> None:
        workspace = Environment(clock).workspace("/main")
        artifact = await workspace.make_artifact("c", ArtCleaning)
        assert {p.name for p in workspace.properties(artifact)} == {"atRoom", "vacuum", "mop", "scrub"}

    clock = VirtualClock()
    run(main, clock)
