"""ArtBumper and ArtCliff: the events of a Kobuki base, as states and as signals."""

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Structure
from jacaros.robots.artifacts.sensors import ArtBumper, ArtCliff


def send(lab: Lab, topic: str, kind: str, **fields: int) -> None:
    publisher = lab.backend.publisher(topic, f"kobuki_msgs/msg/{kind}")
    publisher.publish(publisher.message(**fields))


pytestmark = made(ArtBumper)


async def test_a_bumper_is_a_state_of_its_side_and_a_signal_when_it_is_pressed(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtBumper))
    assert watcher.holds("bumper") == [("left", "released"), ("center", "released"), ("right", "released")]
    send(lab, "/mobile_base/events/bumper", "BumperEvent", bumper=2, state=1)
    await lab.sleep(0.1)
    assert ("right", "pressed") in watcher.holds("bumper")
    assert len(watcher.holds("bumper")) == 3
    send(lab, "/mobile_base/events/bumper", "BumperEvent", bumper=2, state=0)
    await lab.sleep(0.1)
    assert ("right", "released") in watcher.holds("bumper")
    assert watcher.signals == [("tick_Bumper_RIGHT", ())]


@pytest.mark.world("patrol")
async def test_a_robot_that_drives_into_a_wall_presses_its_bumper(lab: Lab, watcher: Watcher) -> None:
    publisher = lab.backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
    for _ in range(80):
        publisher.publish(publisher.message(linear={"x": 0.5}))
        await lab.sleep(0.1)
    assert ("center", "pressed") in watcher.holds("bumper")
    assert watcher.signals == [("tick_Bumper_CENTER", ())]


async def test_a_cliff_is_a_state_of_its_side_below_the_robots_name(lab: Lab) -> None:
    artifact = await lab.make(ArtCliff, "robot_0")
    watcher = lab.watch(artifact)
    for side, word in enumerate(("LEFT", "CENTER", "RIGHT")):
        send(lab, "/robot_0/mobile_base/events/cliff", "CliffEvent", sensor=side, state=1)
        await lab.sleep(0.1)
        assert watcher.signals[-1] == (f"tick_Cliff_{word}", ())
    assert {state for _, state in watcher.holds("cliff")} == {"cliff"}
    await lab.do(artifact, "getCurrentCliff")
    assert watcher.signals[-1] == ("tick_Cliff", ())


@pytest.mark.parametrize(("bumper", "state", "field"), [(3, 1, "bumper"), (0, 2, "state")])
async def test_a_number_that_the_type_does_not_have_is_a_bad_message(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, bumper: int, state: int, field: str
) -> None:
    send(lab, "/mobile_base/events/bumper", "BumperEvent", bumper=bumper, state=state)
    await lab.sleep(0.1)
    why = Structure("out_of_range", (field,))
    assert watcher.signals == [("bad_message", ("/mobile_base/events/bumper", why))]
    await lab.do(artifact, "getCurrentBumper")
    assert watcher.signals[-1] == ("tick_Bumper", ())
