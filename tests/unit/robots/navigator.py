"""An artifact that pursues goals in all ways that there are, and goals that have begun."""

from typing import Any, ClassVar

from fake_actions import FakeServer
from robot_lab import Lab, Run

from jacaros.artifacts import Out, internal_operation, operation
from jacaros.robots.kit.options import positive
from jacaros.robots.kit.ros_artifact import RosArtifact

ACTION = "nav2_msgs/action/NavigateToPose"


class Navigator(RosArtifact):
    """Drives by an action, in all ways that there are."""

    known_options: ClassVar = {"timeout": positive}

    def open(self) -> None:
        self.define_property("distance", -1)
        self.goer = self.action_client("go", ACTION)

    @property
    def limit(self) -> Any:
        return self.options.get("timeout")

    @internal_operation
    def show_distance(self, feedback: Any) -> None:
        """Show how far it is."""
        self.update_property("distance", feedback.distance)

    @operation
    async def go(self, x: float, reached: Out) -> None:
        """Drive, whatever becomes of the intention."""
        result = await self.act(self.goer, {"x": x}, timeout=self.limit, on_feedback=self.show_distance)
        reached.set(result.x)

    @operation(name="goOrRest", pausable=True)
    async def go_or_rest(self, x: float) -> None:
        """Drive; cancelled while suspended."""
        await self.act(
            self.goer,
            {"x": x},
            timeout=self.limit,
            on_feedback=self.show_distance,
            under_way=lambda under_way: self.log("sent" if under_way else "over"),
            suspend="cancel",
        )

    @operation(name="goOften", pausable=True)
    async def go_often(self, times: int) -> None:
        """Drive again and again."""
        for x in range(times):
            await self.act(self.goer, {"x": x}, suspend="cancel")

    @operation
    async def careless(self) -> None:
        """Request cancellation without a pausable operation."""
        await self.act(self.goer, {}, suspend="cancel")

    @operation
    async def send(self, goal: Any) -> None:
        """Send any goal."""
        await self.act(self.goer, goal)


async def begun(
    lab: Lab, operation: str, *options: object, after: float = 1.0, **traits: object
) -> tuple[FakeServer, Run]:
    """A server with some traits, and an operation that has begun so many seconds ago."""
    server = FakeServer(lab)
    for name, value in traits.items():
        assert hasattr(server, name)
        setattr(server, name, value)
    artifact = await lab.make(Navigator, *options)
    outs = (Out(),) if operation == "go" else ()
    going = lab.begin(artifact, operation, 3, *outs)
    if after:
        await lab.sleep(after)
    return server, going


async def suspended(
    lab: Lab, operation: str, *options: object, after: float = 1.0, **traits: object
) -> tuple[FakeServer, Run]:
    """The same, suspended after so many seconds."""
    server, going = await begun(lab, operation, *options, after=after, **traits)
    going.execution.pause()
    return server, going


async def failed(run: Run, reason: str) -> str:
    """Wait for the end, and assert the failure reason; gives the message."""
    await run.done
    assert run.outcome is not None
    assert run.reason == reason
    return str(run.outcome.message)


async def succeeded(run: Run) -> None:
    """Wait for the end, and assert that it is a good one."""
    await run.done
    assert run.outcome is not None
    assert run.outcome.ok
