"""The action and service servers of a robot, as far as their types are installed.

Results match the installed release.
"""

from collections.abc import Awaitable, Callable, Mapping
from typing import Any, NoReturn

from jacaros.ros.action import Abort, Accept, ActionPolicy, ActionServer, GoalStatus, ServerGoal
from jacaros.ros.backend import Backend
from jacaros.ros.errors import RosError, UnknownInterface
from jacaros.ros.names import result_type
from jacaros.ros.node import Capability
from jacaros.ros.services import Handler, Service
from jacaros.sim.description import RobotDescription
from jacaros.sim.navigation.wheels import OVERTAKEN, Overtaken

Execute = Callable[["Goal"], Awaitable[Mapping[str, Any]]]


class Goal:
    """An active goal of one of the robot's actions.

    Attributes:
        request: goal message.
        feedback: sends fields of a feedback message to the client.
    """

    def __init__(self, backend: Backend, type_name: str, served: ServerGoal) -> None:
        self._backend, self._type_name = backend, type_name
        self.request = served.request
        self.feedback = served.feedback

    def abort(self, why: str, /, **result: Any) -> NoReturn:
        """Abort the goal, with a reason and fields of the result."""
        raise Abort(why, self.result({**result, "error_msg": why}))

    def result(self, fields: Mapping[str, Any]) -> dict[str, Any]:
        """Remove fields that the installed release of the action lacks (``error_msg`` came with Kilted)."""
        known = self._backend.fields(result_type(self._type_name))
        return {name: value for name, value in fields.items() if name in known}


class Servers:
    """The servers of one robot.

    Args:
        backend: graph.
        robot: has these servers, as far as its kind has them.
    """

    def __init__(self, backend: Backend, robot: RobotDescription) -> None:
        self.backend, self._robot = backend, robot
        self._servers: list[ActionServer | Service] = []

    def name(self, name: str) -> str | None:
        """Return the robot's name for a topic, service or action; None if its kind does not have it."""
        namespace = self._robot.namespace
        return self._robot.interface.name_of(name, f"/{namespace}" if namespace else "")

    def action(
        self,
        name: str,
        type_name: str,
        execute: Execute,
        accept: Accept | None = None,
        overtaken: GoalStatus = GoalStatus.ABORTED,
    ) -> None:
        """Offer an action whose newer goals preempt older ones, which then end as *overtaken*.

        If the type of the action is unknown, log a warning instead.
        """
        offered = self.name(name)
        if offered is None or Capability.ACTIONS not in self.backend.capabilities:
            return

        async def carry_out(served: ServerGoal) -> Any:
            goal = Goal(self.backend, type_name, served)
            try:
                return goal.result(await execute(goal))
            except Overtaken:
                goal.abort(OVERTAKEN, success=False)

        policy = ActionPolicy(accept=accept, preempt=True, overtaken=overtaken)
        try:
            server = self.backend.action_server(offered, type_name, carry_out, policy)
        except UnknownInterface:
            self.left_out(f"action {offered}", type_name)
            return
        self._servers.append(server)

    def service(self, name: str, type_name: str, handler: Handler) -> None:
        """Offer a service; if its type is unknown, log a warning instead."""
        offered = self.name(name)
        if offered is None:
            return
        try:
            self._servers.append(self.backend.service(offered, type_name, handler))
        except UnknownInterface:
            self.left_out(f"service {offered}", type_name)

    def left_out(self, what: str, type_name: str) -> None:
        """Log a warning about a server that cannot be offered."""
        try:
            self.backend.rosout("warn", f"{what} is not offered: unknown type {type_name}")
        except RosError:
            return

    def close(self) -> None:
        """Withdraw all servers; active goals are aborted."""
        for server in self._servers:
            server.close()
        self._servers.clear()
