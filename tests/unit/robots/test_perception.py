"""ArtPerception: percepts that another program sends as texts."""

from robot_lab import Lab, in_lab

from jacaros.artifacts import Out, Structure
from jacaros.robots.artifacts.thesis import ArtPerception


async def test_the_texts_of_the_newest_message_are_properties(lab: Lab) -> None:
    artifact = await lab.make(ArtPerception)
    watcher = lab.watch(artifact)
    publisher = lab.backend.publisher("/jason/perception", "perception_msgs/msg/perception")
    for texts in (["box1,1.0,2.0,3.1", "box2,0,0,0"], ["box2,0,0,0"]):
        publisher.publish(publisher.message(perception=texts))
        await lab.sleep(0.1)
        assert watcher.holds("perception") == [(each,) for each in texts]
    assert len(watcher.values("perception")) == 2, "a text that stays gives no event"
    out = Out()
    await lab.do(artifact, "getPerception", out)
    assert out.value == ["box2,0,0,0"]
    await lab.do(artifact, "getPerception")
    assert watcher.signals == [("tick_perception", ())]


async def test_parts_between_commas_are_values_on_request(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtPerception, Structure("split", (True,))))
    publisher = lab.backend.publisher("/jason/perception", "perception_msgs/msg/perception")
    publisher.publish(publisher.message(perception=["box1,1.0, -2,3.1", "fog", "wind,nan"]))
    await lab.sleep(0.1)
    assert watcher.holds("perception") == [("box1", 1.0, -2.0, 3.1), ("fog",), ("wind", "nan")]


def test_objects_in_the_view_of_the_robot_are_perceived() -> None:
    world = """\
walls: [{segment: [[1, 0.2], [1, 2]]}]
robots: [{name: robot}]
objects:
  - {name: cup, x: 0.5, y: -0.1}
  - {name: hidden, x: 1.5, y: 0.5}
  - {name: behind, x: -1, y: 0}
  - {name: aside, x: 1, y: -1}
  - {name: far, x: 5, y: 0}
"""

    async def body(lab: Lab) -> None:
        watcher = lab.watch(await lab.make(ArtPerception))
        await lab.sleep(1)
        assert watcher.values("perception") == [("cup,0.50,-0.10,0.00",)]

    in_lab(body, world)
