"""Docking actions: Nav2's, those of the TurtleBot 4 (Create 3) with its short motions, and that of the Kobuki."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from jacaros.plane.pose import Placement
from jacaros.ros.action import Accept, GoalStatus
from jacaros.sim.data.world import Dock
from jacaros.sim.graph.frames import ODOMETRY, FrameUnknown, on_map, pose_fault, stamped_pose
from jacaros.sim.graph.on_graph import Execute, Goal
from jacaros.sim.navigation.docking import FAILED_TO_STAGE, Docking
from jacaros.sim.navigation.planner import NavigationFailure

_DOCK_AT = 0.5
"""Tolerance in metres between a dock and the pose in a goal."""
_KOBUKI = {1: "GET_STREAM", 2: "SCAN", 3: "ALIGNED", 4: "DOCKED_IN"}
"""The states of the Kobuki's docking that are nearest to those of Nav2."""


class DockServers:
    """Serves docking of one robot."""

    def __init__(self, docking: Docking) -> None:
        self.docking = docking
        self._navigator = docking.navigator
        self._at = docking.navigator.at

    def offer_nav2(self) -> None:
        """``/dock_robot`` and ``/undock_robot``."""
        self._serve(
            "/dock_robot",
            "nav2_msgs/action/DockRobot",
            self._dock_robot,
            lambda goal: None if goal.use_dock_id else pose_fault(goal.dock_pose.pose),
        )
        self._serve("/undock_robot", "nav2_msgs/action/UndockRobot", self._undock_robot)

    def offer_create3(self) -> None:
        """``/dock``, ``/undock``, ``/drive_distance`` and ``/rotate_angle``."""
        self._create3("/dock", "Dock", self._dock, self._cannot_dock)
        self._create3("/undock", "Undock", self._undock, self._cannot_undock)
        self._create3("/drive_distance", "DriveDistance", self._drive_distance)
        self._create3("/rotate_angle", "RotateAngle", self._rotate_angle)

    def offer_kobuki(self) -> None:
        """``/dock_drive_action``."""
        self._serve(
            "/dock_drive_action",
            "kobuki_msgs/action/AutoDocking",
            self._auto_docking,
            overtaken=GoalStatus.CANCELED,
        )

    def _serve(
        self,
        name: str,
        type_name: str,
        execute: Execute,
        accept: Accept | None = None,
        overtaken: GoalStatus = GoalStatus.ABORTED,
    ) -> None:
        """Serve an action; a failure sets those of the fields below that its result has."""

        async def carry_out(goal: Goal) -> Mapping[str, Any]:
            try:
                return await execute(goal)
            except NavigationFailure as failure:
                goal.abort(
                    failure.text,
                    success=False,
                    error_code=failure.code,
                    is_docked=self.docking.docked,
                    text=failure.text,
                    pose=self._pose(),
                )

        self._at.action(name, type_name, carry_out, accept, overtaken)

    def _create3(
        self, name: str, action: str, execute: Execute, cannot: Callable[[], str | None] = lambda: None
    ) -> None:
        """Serve an action that, like a Create 3, rejects impossible goals, and a second goal while one is running."""
        running = 0

        async def carry_out(goal: Goal) -> Mapping[str, Any]:
            nonlocal running
            running += 1
            try:
                return await execute(goal)
            finally:
                running -= 1

        def accept(request: Any) -> str | None:
            return f"{name} is running; cancel that goal first" if running else cannot()

        self._serve(name, f"irobot_create_msgs/action/{action}", carry_out, accept)

    async def _dock_robot(self, goal: Goal) -> Mapping[str, Any]:
        clock = self._at.time.clock
        began = clock.now()

        def tell(state: int) -> None:
            goal.feedback(state=state, docking_time=clock.now() - began)

        request = goal.request
        if request.use_dock_id:
            dock = self.docking.dock_called(request.dock_id)
        else:
            dock = self.docking.dock_near(await self._place(request.dock_pose), _DOCK_AT)
        limit = request.max_staging_time or math.inf
        await self.docking.dock(dock, request.navigate_to_staging_pose, tell, limit)
        return {"success": True}

    async def _place(self, stamped: Any) -> Placement:
        self._navigator.pose()
        try:
            return await on_map(self._at, stamped)
        except FrameUnknown as problem:
            raise NavigationFailure(FAILED_TO_STAGE, str(problem)) from None

    async def _undock_robot(self, goal: Goal) -> Mapping[str, Any]:
        if not self.docking.docked:
            # Nav2 has nothing to do, and aborts without a code.
            raise NavigationFailure(0, "the robot is not docked")
        await self.docking.undock(goal.request.max_undocking_time or math.inf)
        return {"success": True}

    def _cannot_dock(self) -> str | None:
        if self.docking.docked:
            return "the robot is already docked"
        return "no dock in sight" if self.docking.visible_dock() is None else None

    def _cannot_undock(self) -> str | None:
        return None if self.docking.docked else "the robot is not docked"

    def _dock_in_sight(self) -> Dock:
        dock = self.docking.visible_dock()
        if dock is None:  # the robot was pushed after the goal was accepted
            raise NavigationFailure(0, "no dock in sight")
        return dock

    async def _dock(self, goal: Goal) -> Mapping[str, Any]:
        goal.feedback(sees_dock=self.docking.visible_dock() is not None)
        await self.docking.dock(self._dock_in_sight(), True, lambda state: goal.feedback(sees_dock=True))
        return {"is_docked": self.docking.docked}

    async def _undock(self, goal: Goal) -> Mapping[str, Any]:
        await self.docking.undock()
        await self.docking.turn_away()
        return {"is_docked": self.docking.docked}

    async def _auto_docking(self, goal: Goal) -> Mapping[str, Any]:
        dock = self._dock_in_sight()
        await self.docking.dock(
            dock, True, lambda state: goal.feedback(state=_KOBUKI.get(state, "SCAN"), text=dock.name)
        )
        return {"text": f"docked in {dock.name}"}

    async def _drive_distance(self, goal: Goal) -> Mapping[str, Any]:
        request = goal.request
        speed = min(max(request.max_translation_speed, 0.02), self._at.robot.description.limits.speed)
        with self._navigator.wheels.claimed() as claim:
            made = await self._navigator.straight(
                claim, request.distance, speed, lambda left: goal.feedback(remaining_travel_distance=left)
            )
        return self._moved(made, request.distance, 0.02, "m")

    async def _rotate_angle(self, goal: Goal) -> Mapping[str, Any]:
        request = goal.request
        rate = min(max(request.max_rotation_speed, 0.05), self._at.robot.description.limits.turn_rate)
        with self._navigator.wheels.claimed() as claim:
            made = await self._navigator.rotate(
                claim, request.angle, rate, lambda left: goal.feedback(remaining_angle_travel=left)
            )
        return self._moved(made, request.angle, 0.05, "rad")

    def _moved(self, made: float, wanted: float, tolerance: float, unit: str) -> Mapping[str, Any]:
        if abs(made) < abs(wanted) - tolerance:
            raise NavigationFailure(0, f"blocked after {abs(made):.2f} {unit}")
        return {"pose": self._pose()}

    def _pose(self) -> Any:
        return stamped_pose(self._at, self._at.robot.odometry.placement, ODOMETRY)
