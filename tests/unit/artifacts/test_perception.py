"""ArtPerception: percepts that another program sends as texts."""

from robot_lab import Lab, in_lab

from jacaros.artifacts.thesis.perception import ArtPerception
from jacaros.env import Out


def test_the_texts_of_the_newest_message_are_properties() -> None:
    async def body(lab: Lab) -> None:
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

    in_lab(body, None)
