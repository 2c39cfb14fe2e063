"""Docking, undocking and short motions, and their actions: Nav2's, the Kobuki's, and the Create 3's."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from jacaros.robots.plane.pose import Placement, distance
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.world.data.world import Dock
from jacaros.robots.world.graph.frames import FrameUnknown, on_map, pose_fault
from jacaros.robots.world.graph.on_graph import ActiveGoal, GoalExecution
from jacaros.robots.world.navigation.driver import STOP
from jacaros.robots.world.navigation.navigator import PERIOD, Navigator
from jacaros.robots.world.navigation.planner import GOAL_MARGIN, NavigationFailure
from jacaros.robots.world.navigation.trip import go

STAGING = 0.5
"""Distance of the staging pose from the dock, in metres."""
DOCK_NOT_IN_DB, DOCK_NOT_VALID, FAILED_TO_STAGE, FAILED_TO_CONTROL, FAILED_TO_CHARGE = 901, 902, 903, 905, 906
DOCKING_TIMEOUT = 907
"""Error codes of Nav2's ``DockRobot`` and ``UndockRobot``."""
SPIN_COLLISION_AHEAD, DRIVE_COLLISION_AHEAD = 703, 723
"""Error codes of Nav2's ``Spin`` and ``DriveOnHeading``."""
NAV_TO_STAGING_POSE, INITIAL_PERCEPTION, CONTROLLING, WAIT_FOR_CHARGE = 1, 2, 3, 4
"""States of the feedback of ``DockRobot``."""
_CHARGES_WITHIN = 2.0
_UNDOCKED = 0.12
_BACK_SPEED = 0.2

_DOCK_AT = 0.5
"""Tolerance in metres between a dock and the pose in a goal."""
_KOBUKI = {1: "GET_STREAM", 2: "SCAN", 3: "ALIGNED", 4: "DOCKED_IN"}
"""The states of the Kobuki's docking that are nearest to those of Nav2."""

TellState = Callable[[int], object]


class Docking:
    """Docks and undocks one robot, and serves it.

    Args:
        navigator: drives the robot.
    """

    def __init__(self, navigator: Navigator) -> None:
        self.navigator = navigator
        self._at = navigator.at

    @property
    def docked(self) -> bool:
        """Whether the charging contacts touch a dock."""
        self._at.time.catch_up()
        return self._at.robot.dock is not None

    def dock_called(self, name: str) -> Dock:
        """Return the dock with that name.

        Raises:
            NavigationFailure: the name is unknown.
        """
        docks = self._at.time.world.description.docks
        for dock in docks:
            if dock.name == name:
                return dock
        known = ", ".join(dock.name for dock in docks) or "none"
        raise NavigationFailure(DOCK_NOT_IN_DB, f"unknown dock '{name}'; docks: {known}")

    def dock_near(self, place: Placement, within: float) -> Dock:
        """Return the nearest dock, at most *within* metres from a place.

        Raises:
            NavigationFailure: no dock is that near.
        """

        def apart(dock: Dock) -> float:
            return distance((place.x, place.y), (dock.pose.x, dock.pose.y))

        near = [dock for dock in self._at.time.world.description.docks if apart(dock) <= within]
        if not near:
            raise NavigationFailure(DOCK_NOT_VALID, f"no dock at ({place.x:.2f}, {place.y:.2f})")
        return min(near, key=apart)

    def visible_dock(self) -> Dock | None:
        """Return the nearest dock that the robot detects from its pose."""
        self._at.time.catch_up()
        return self._at.time.world.visible_dock(self._at.robot)

    async def dock(self, dock: Dock, stage: bool, tell: TellState, limit: float = math.inf) -> None:
        """Drive to the staging pose (if *stage*, within *limit* seconds), into the dock, and wait for the charging current.

        Raises:
            NavigationFailure: docking failed; with the codes of this file.
            Overtaken: another goal has claimed the wheels.
        """
        robot = self._at.robot
        if self.docked and robot.dock is dock:
            return
        if stage:
            tell(NAV_TO_STAGING_POSE)
            await self._part(FAILED_TO_STAGE, self._staging_pose(dock), limit)
        tell(INITIAL_PERCEPTION)
        tell(CONTROLLING)
        await self._part(FAILED_TO_CONTROL, self._berth(dock))
        tell(WAIT_FOR_CHARGE)
        with self.navigator.wheels.claimed() as claim:
            for _ in range(round(_CHARGES_WITHIN / PERIOD)):
                if self.docked:
                    return
                await claim.drive(STOP)
        raise NavigationFailure(FAILED_TO_CHARGE, f"dock '{dock.name}' gives no current")

    async def undock(self, limit: float = math.inf) -> None:
        """Leave the dock within *limit* seconds: backwards if there is room, otherwise forwards.

        Raises:
            NavigationFailure: the way is blocked.
            Overtaken: another goal has claimed the wheels.
        """
        dock = self._at.robot.dock
        if not self.docked or dock is None:
            return
        clock = self._at.time.clock
        over = clock.now() + limit
        with self.navigator.wheels.claimed() as claim:
            for sign in (-1.0, 1.0):
                await self.navigator.straight(claim, sign * STAGING, _BACK_SPEED, limit=over - clock.now())
                x, y, _ = self._at.robot.pose  # of the contacts, whatever localisation says
                if distance((x, y), (dock.pose.x, dock.pose.y)) > dock.radius + _UNDOCKED:
                    return
        if clock.now() >= over:
            raise NavigationFailure(DOCKING_TIMEOUT, f"still in dock '{dock.name}' after {limit:g} s")
        raise NavigationFailure(FAILED_TO_CONTROL, f"no room to leave dock '{dock.name}'")

    async def turn_away(self) -> None:
        """Turn round, as a Create 3 does after undocking."""
        with self.navigator.wheels.claimed() as claim:
            await self.navigator.rotate(claim, math.pi, 1.0)

    async def _part(self, code: int, place: Placement | None, limit: float = math.inf) -> None:
        if place is None:
            return
        try:
            await go(self.navigator, [place], bool, limit)
        except NavigationFailure as failure:
            raise NavigationFailure(code, failure.text) from None

    def _staging_pose(self, dock: Dock) -> Placement | None:
        """Return the staging pose in front of the dock, facing it; None if it is not free."""
        berth = Placement.at(*dock.pose)
        place = Placement(*berth.point(-STAGING, 0.0), berth.cosine, berth.sine)
        return place if self._room(place) else None

    def _berth(self, dock: Dock) -> Placement:
        """Return the docked pose: as near to the middle of the dock as walls allow."""
        berth = Placement.at(*dock.pose)
        for step in range(math.floor(0.8 * dock.radius / 0.02) + 1):
            place = Placement(*berth.point(-0.02 * step, 0.0), berth.cosine, berth.sine)
            if self._room(place):
                return place
        return berth

    def _room(self, place: Placement) -> bool:
        planner = self.navigator.planner
        return planner.grid.clearance_at(place.x, place.y) >= planner.radius + GOAL_MARGIN

    def offer_nav2(self) -> None:
        """``/dock_robot``, ``/undock_robot``, ``/spin`` and ``/drive_on_heading``."""
        self.navigator.serve(
            "/dock_robot",
            "nav2_msgs/action/DockRobot",
            self._dock_robot,
            lambda goal: None if goal.use_dock_id else pose_fault(goal.dock_pose.pose),
        )
        self.navigator.serve("/undock_robot", "nav2_msgs/action/UndockRobot", self._undock_robot)
        self.navigator.serve("/spin", "nav2_msgs/action/Spin", self._spin)
        self.navigator.serve("/drive_on_heading", "nav2_msgs/action/DriveOnHeading", self._drive_on_heading)

    def offer_create3(self) -> None:
        """``/dock``, ``/undock``, ``/drive_distance`` and ``/rotate_angle``."""
        self._create3("/dock", "Dock", self._dock, self._cannot_dock)
        self._create3("/undock", "Undock", self._undock, self._cannot_undock)
        self._create3("/drive_distance", "DriveDistance", self._drive_distance)
        self._create3("/rotate_angle", "RotateAngle", self._rotate_angle)

    def offer_kobuki(self) -> None:
        """``/dock_drive_action``."""
        self.navigator.serve(
            "/dock_drive_action",
            "kobuki_msgs/action/AutoDocking",
            self._auto_docking,
            overtaken=GoalStatus.CANCELED,
        )

    def _create3(
        self, name: str, action: str, execute: GoalExecution, cannot: Callable[[], str | None] = lambda: None
    ) -> None:
        """Serve an action that, like a Create 3, rejects impossible goals, and a second goal while one is running."""
        running = 0

        async def carry_out(goal: ActiveGoal) -> Mapping[str, Any]:
            nonlocal running
            running += 1
            try:
                return await execute(goal)
            finally:
                running -= 1

        def accept(request: Any) -> str | None:
            return f"{name} is running; cancel that goal first" if running else cannot()

        self.navigator.serve(name, f"irobot_create_msgs/action/{action}", carry_out, accept)

    async def _dock_robot(self, goal: ActiveGoal) -> Mapping[str, Any]:
        clock = self._at.time.clock
        began = clock.now()

        def tell(state: int) -> None:
            goal.feedback(state=state, docking_time=clock.now() - began)

        request = goal.request
        if request.use_dock_id:
            dock = self.dock_called(request.dock_id)
        else:
            dock = self.dock_near(await self._place(request.dock_pose), _DOCK_AT)
        limit = request.max_staging_time or math.inf
        await self.dock(dock, request.navigate_to_staging_pose, tell, limit)
        return {"success": True}

    async def _place(self, stamped: Any) -> Placement:
        self.navigator.pose()
        try:
            return await on_map(self._at, stamped)
        except FrameUnknown as problem:
            raise NavigationFailure(FAILED_TO_STAGE, str(problem)) from None

    async def _undock_robot(self, goal: ActiveGoal) -> Mapping[str, Any]:
        if not self.docked:
            # Nav2 has nothing to do, and aborts without a code.
            raise NavigationFailure(0, "the robot is not docked")
        await self.undock(goal.request.max_undocking_time or math.inf)
        return {"success": True}

    def _cannot_dock(self) -> str | None:
        if self.docked:
            return "the robot is already docked"
        return "no dock in sight" if self.visible_dock() is None else None

    def _cannot_undock(self) -> str | None:
        return None if self.docked else "the robot is not docked"

    def _dock_in_sight(self) -> Dock:
        dock = self.visible_dock()
        if dock is None:  # the robot was pushed after the goal was accepted
            raise NavigationFailure(0, "no dock in sight")
        return dock

    async def _dock(self, goal: ActiveGoal) -> Mapping[str, Any]:
        goal.feedback(sees_dock=self.visible_dock() is not None)
        await self.dock(self._dock_in_sight(), True, lambda state: goal.feedback(sees_dock=True))
        return {"is_docked": self.docked}

    async def _undock(self, goal: ActiveGoal) -> Mapping[str, Any]:
        await self.undock()
        await self.turn_away()
        return {"is_docked": self.docked}

    async def _auto_docking(self, goal: ActiveGoal) -> Mapping[str, Any]:
        dock = self._dock_in_sight()
        await self.dock(
            dock, True, lambda state: goal.feedback(state=_KOBUKI.get(state, "SCAN"), text=dock.name)
        )
        return {"text": f"docked in {dock.name}"}

    async def _drive_distance(self, goal: ActiveGoal) -> Mapping[str, Any]:
        request = goal.request
        speed = min(max(request.max_translation_speed, 0.02), self._at.robot.description.limits.speed)
        with self.navigator.wheels.claimed() as claim:
            made = await self.navigator.straight(
                claim, request.distance, speed, lambda left: goal.feedback(remaining_travel_distance=left)
            )
        return self._moved(made, request.distance, 0.02, "m")

    async def _rotate_angle(self, goal: ActiveGoal) -> Mapping[str, Any]:
        request = goal.request
        rate = min(max(request.max_rotation_speed, 0.05), self._at.robot.description.limits.turn_rate)
        with self.navigator.wheels.claimed() as claim:
            made = await self.navigator.rotate(
                claim, request.angle, rate, lambda left: goal.feedback(remaining_angle_travel=left)
            )
        return self._moved(made, request.angle, 0.05, "rad")

    async def _spin(self, goal: ActiveGoal) -> Mapping[str, Any]:
        angle = float(goal.request.target_yaw)
        with self.navigator.wheels.claimed() as claim:
            made = await self.navigator.rotate(claim, angle, self.navigator.pace.turn_rate)
        return self._moved(made, angle, 0.05, "rad", SPIN_COLLISION_AHEAD)

    async def _drive_on_heading(self, goal: ActiveGoal) -> Mapping[str, Any]:
        request = goal.request
        metres, limit = float(request.target.x), to_seconds(request.time_allowance) or math.inf
        speed = min(max(abs(request.speed), 0.02), self._at.robot.description.limits.speed)
        with self.navigator.wheels.claimed() as claim:
            made = await self.navigator.straight(
                claim, metres, speed, lambda left: goal.feedback(distance_traveled=abs(metres) - left), limit
            )
        return self._moved(made, metres, 0.02, "m", DRIVE_COLLISION_AHEAD)

    def _moved(
        self, made: float, wanted: float, tolerance: float, unit: str, code: int = 0
    ) -> Mapping[str, Any]:
        if abs(made) < abs(wanted) - tolerance:
            raise NavigationFailure(code, f"blocked after {abs(made):.2f} {unit}")
        return {"pose": self.navigator.odometry_pose()}
