"""Parameters that an artifact declares: others set them, and they go with it."""

from robot_lab import Lab

from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.parameter import DeclaredParameter


class Speedy(RosArtifact):
    """Has a parameter."""

    def open(self) -> None:
        self.define_property(
            "speed", self.declared_parameter("speed", DeclaredParameter(0.5, read_only=True))
        )


async def test_a_declared_parameter_goes_with_its_artifact(lab: Lab) -> None:
    before = await lab.backend.parameters().names()
    for _ in range(2):
        artifact = await lab.make(Speedy)
        assert await lab.backend.parameters().get("speed") == 0.5
        lab.workspace.dispose_artifact(artifact)
        assert await lab.backend.parameters().names() == before
