"""An artifact over the action Count, as its authors write one."""

from typing import Any

from jacaros.artifacts import Out, internal_operation, operation
from jacaros.robots.kit.ros_artifact import RosArtifact


class CountingRobot(RosArtifact):
    """Counts by the action `count`.

    Properties:
        current(N): the number that was counted last; 0 at first.
    """

    def open(self) -> None:
        """Define the property; the server is looked for when a goal is sent."""
        self.define_property("current", 0)
        self.counter = self.action_client("count", "jacaros_interfaces/action/Count")

    @internal_operation
    def show(self, feedback: Any) -> None:
        """Show how far it is."""
        self.update_property("current", feedback.current)

    async def _count(self, target: int, period: float, **conduct: Any) -> Any:
        goal = {"target": target, "period": period}
        return await self.act(self.counter, goal, on_feedback=self.show, **conduct)

    @operation
    async def count(self, target: int, period: float, last: Out) -> None:
        """Count up to *target*, one number in each period (seconds); gives the last number."""
        last.set((await self._count(target, period)).last)

    @operation(name="countWithin")
    async def count_within(self, seconds: float, target: int, period: float) -> None:
        """Count in so many seconds at most."""
        await self._count(target, period, timeout=seconds)

    @operation(name="countOrRest", pausable=True)
    async def count_or_rest(self, target: int, period: float) -> None:
        """Count; a suspended intention begins anew when it is resumed."""
        await self._count(target, period, suspend="cancel")
