"""A topic callback that fails: the fault is logged, and the subscription stays."""

from robot_lab import Lab, in_lab

from jacaros.artifacts import internal_operation
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.node import Sample


class Ears(RosArtifact):
    def open(self) -> None:
        self.define_property("heard", "")
        self.subscription("chatter", "std_msgs/msg/String", self.hear)

    def hear(self, sample: Sample) -> None:
        if sample.message.data == "noise":
            raise ValueError("a stone in the ear")
        self.start(self.show, sample.message.data)

    @internal_operation
    def show(self, text: str) -> None:
        self.update_property("heard", text)


def test_a_failing_callback_is_logged_and_called_again() -> None:
    async def body(lab: Lab) -> None:
        watcher = lab.watch(await lab.make(Ears, name="ears"))
        publisher = lab.backend.publisher("/chatter", "std_msgs/msg/String")
        for word in ("one", *("noise",) * 25, "two"):
            publisher.publish(publisher.message(data=word))
            await lab.sleep(0.1)
        assert watcher.values("heard") == [("",), ("one",), ("two",)]

    lab = in_lab(body, None)
    heads = [line for line in lab.logged if "callback" in line]
    assert heads == [
        "[ears] the callback of topic /chatter failed:",
        "[ears] the callback of topic /chatter failed (10 times so far):",
    ]
    assert any("test_listener.py" in line for line in lab.logged)
    assert lab.logged[-1] == "[ears]   ValueError: a stone in the ear"
