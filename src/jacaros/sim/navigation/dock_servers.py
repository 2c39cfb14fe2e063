"""Docking actions: Nav2's, those of the TurtleBot 4 (Create 3) with its short motions, and that of the Kobuki."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from jacaros.plane.pose import Placement
from jacaros.ros.action import GoalStatus
from jacaros.sim.navigation.docking import FAILED_TO_STAGE, Docking
from jacaros.sim.navigation.failure import NavigationFailure
from jacaros.sim.navigation.frames import ODOMETRY, Frames, FrameUnknown, fault_of, fill_in
from jacaros.sim.navigation.servers import Execute, Goal, Servers

_DOCK_AT = 0.5
"""Tolerance in metres between a dock and the pose in a goal."""


class DockServers:
    """Serves docking of one robot.

    Args:
        docking: docks the robot.
        frames: frames of the robot.
        servers: action servers of the robot.
    """

    def __init__(self, docking: Docking, frames: Frames, servers: Servers) -> None:
        self.docking, self.frames, self.servers = docking, frames, servers
        self._navigator = docking.navigator
        self._backend = servers.backend

    def offer_nav2(self) -> None:
        """``/dock_robot`` and ``/undock_robot``."""
        self.servers.action(
            "/dock_robot",
            "nav2_msgs/action/DockRobot",
            self._dock_robot,
            lambda goal: None if goal.use_dock_id else fault_of(goal.dock_pose),
        )
        self.servers.action("/undock_robot", "nav2_msgs/action/UndockRobot", self._undock_robot)

    def offer_create3(self) -> None:
        """``/dock``, ``/undock``, ``/drive_distance`` and ``/rotate_angle``."""
        self._create3("/dock", "Dock", self._dock, self._cannot_dock)
        self._create3("/undock", "Undock", self._undock, self._cannot_undock)
        self._create3("/drive_distance", "DriveDistance", self._drive_distance)
        self._create3("/rotate_angle", "RotateAngle", self._rotate_angle)

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

        self.servers.action(name, f"irobot_create_msgs/action/{action}", carry_out, accept)

    def offer_kobuki(self) -> None:
        """``/dock_drive_action``."""
        self.servers.action(
            "/dock_drive_action",
            "kobuki_msgs/action/AutoDocking",
            self._auto_docking,
            overtaken=GoalStatus.CANCELED,
        )

    async def _dock_robot(self, goal: Goal) -> Mapping[str, Any]:
        clock = self._navigator.time.clock
        began = clock.now()

        def tell(state: int) -> None:
            goal.feedback(state=state, docking_time=clock.now() - began)

        request = goal.request
        try:
            if request.use_dock_id:
                dock = self.docking.dock_called(request.dock_id)
            else:
                dock = self.docking.dock_near(await self._place(request.dock_pose), _DOCK_AT)
            limit = request.max_staging_time or math.inf
            await self.docking.dock(dock, request.navigate_to_staging_pose, tell, limit)
        except NavigationFailure as failure:
            goal.abort(failure.text, success=False, error_code=failure.code)
        return {"success": True}

    async def _place(self, stamped: Any) -> Placement:
        self._navigator.pose()
        try:
            return await self.frames.on_map(stamped)
        except FrameUnknown as problem:
            raise NavigationFailure(FAILED_TO_STAGE, str(problem)) from None

    async def _undock_robot(self, goal: Goal) -> Mapping[str, Any]:
        if not self.docking.docked:
            # Nav2 has nothing to do, and aborts without a code.
            goal.abort("the robot is not docked", success=False)
        try:
            await self.docking.undock(goal.request.max_undocking_time or math.inf)
        except NavigationFailure as failure:
            goal.abort(failure.text, success=False, error_code=failure.code)
        return {"success": True}

    def _cannot_dock(self) -> str | None:
        if self.docking.docked:
            return "the robot is already docked"
        return "no dock in sight" if self.docking.visible_dock() is None else None

    def _cannot_undock(self) -> str | None:
        return None if self.docking.docked else "the robot is not docked"

    async def _dock(self, goal: Goal) -> Mapping[str, Any]:
        dock = self.docking.visible_dock()
        goal.feedback(sees_dock=dock is not None)
        if dock is None:  # the robot was pushed after the goal was accepted
            goal.abort("no dock in sight", is_docked=False)
        try:
            await self.docking.dock(dock, True, lambda state: goal.feedback(sees_dock=True))
        except NavigationFailure as failure:
            goal.abort(failure.text, is_docked=self.docking.docked)
        return {"is_docked": self.docking.docked}

    async def _undock(self, goal: Goal) -> Mapping[str, Any]:
        try:
            await self.docking.undock()
        except NavigationFailure as failure:
            goal.abort(failure.text, is_docked=self.docking.docked)
        await self.docking.turn_away()
        return {"is_docked": self.docking.docked}

    async def _auto_docking(self, goal: Goal) -> Mapping[str, Any]:
        dock = self.docking.visible_dock()
        if dock is None:
            goal.abort("no dock in sight", text="no dock in sight")
        try:
            await self.docking.dock(
                dock, True, lambda state: goal.feedback(state=_KOBUKI.get(state, "SCAN"), text=dock.name)
            )
        except NavigationFailure as failure:
            goal.abort(failure.text, text=failure.text)
        return {"text": f"docked in {dock.name}"}

    async def _drive_distance(self, goal: Goal) -> Mapping[str, Any]:
        request = goal.request
        speed = min(max(request.max_translation_speed, 0.02), self._navigator.robot.description.limits.speed)
        with self._navigator.wheels.claimed() as claim:
            made = await self._navigator.straight(
                claim, request.distance, speed, lambda left: goal.feedback(remaining_travel_distance=left)
            )
        pose = self._pose()
        if abs(made) < abs(request.distance) - 0.02:
            goal.abort(f"blocked after {abs(made):.2f} m", pose=pose)
        return {"pose": pose}

    async def _rotate_angle(self, goal: Goal) -> Mapping[str, Any]:
        request = goal.request
        rate = min(max(request.max_rotation_speed, 0.05), self._navigator.robot.description.limits.turn_rate)
        with self._navigator.wheels.claimed() as claim:
            made = await self._navigator.rotate(
                claim, request.angle, rate, lambda left: goal.feedback(remaining_angle_travel=left)
            )
        pose = self._pose()
        if abs(made) < abs(request.angle) - 0.05:
            goal.abort(f"blocked after {abs(made):.2f} rad", pose=pose)
        return {"pose": pose}

    def _pose(self) -> Any:
        return fill_in(
            self._backend.message("geometry_msgs/msg/PoseStamped"),
            self._navigator.robot.odometry.placement,
            self.frames.prefix + ODOMETRY,
            self._navigator.time.now(),
        )


_KOBUKI = {1: "GET_STREAM", 2: "SCAN", 3: "ALIGNED", 4: "DOCKED_IN"}
"""The states of the Kobuki's docking that are nearest to those of Nav2."""
