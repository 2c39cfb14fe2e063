"""Docking and undocking."""

import math
from collections.abc import Callable

from jacaros.plane.pose import Placement, distance
from jacaros.sim.data.world import Dock
from jacaros.sim.navigation.driver import STOP
from jacaros.sim.navigation.navigator import PERIOD, Navigator
from jacaros.sim.navigation.planner import GOAL_MARGIN, NavigationFailure
from jacaros.sim.navigation.trip import go

STAGING = 0.5
"""Distance of the staging pose from the dock, in metres."""
DOCK_NOT_IN_DB, DOCK_NOT_VALID, FAILED_TO_STAGE, FAILED_TO_CONTROL, FAILED_TO_CHARGE = 901, 902, 903, 905, 906
DOCKING_TIMEOUT = 907
"""Error codes of Nav2's ``DockRobot`` and ``UndockRobot``."""
NAV_TO_STAGING_POSE, INITIAL_PERCEPTION, CONTROLLING, WAIT_FOR_CHARGE = 1, 2, 3, 4
"""States of the feedback of ``DockRobot``."""
_CHARGES_WITHIN = 2.0
_UNDOCKED = 0.12
_BACK_SPEED = 0.2

TellState = Callable[[int], object]


class Docking:
    """Docks and undocks one robot.

    Args:
        navigator: drives the robot.
    """

    def __init__(self, navigator: Navigator) -> None:
        self.navigator = navigator

    @property
    def docked(self) -> bool:
        """Whether the charging contacts touch a dock."""
        self.navigator.time.catch_up()
        return self.navigator.robot.dock is not None

    def dock_called(self, name: str) -> Dock:
        """Return the dock with that name.

        Raises:
            NavigationFailure: the name is unknown.
        """
        docks = self.navigator.time.world.description.docks
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

        near = [dock for dock in self.navigator.time.world.description.docks if apart(dock) <= within]
        if not near:
            raise NavigationFailure(DOCK_NOT_VALID, f"no dock at ({place.x:.2f}, {place.y:.2f})")
        return min(near, key=apart)

    def visible_dock(self) -> Dock | None:
        """Return the nearest dock that the robot detects from its pose."""
        self.navigator.time.catch_up()
        return self.navigator.time.world.visible_dock(self.navigator.robot)

    async def dock(self, dock: Dock, stage: bool, tell: TellState, limit: float = math.inf) -> None:
        """Drive to the staging pose (if *stage*, within *limit* seconds), into the dock, and wait for the charging current.

        Raises:
            NavigationFailure: docking failed; with the codes of this file.
            Overtaken: another goal has claimed the wheels.
        """
        robot = self.navigator.robot
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
        dock = self.navigator.robot.dock
        if not self.docked or dock is None:
            return
        clock = self.navigator.time.clock
        over = clock.now() + limit
        with self.navigator.wheels.claimed() as claim:
            for sign in (-1.0, 1.0):
                await self.navigator.straight(claim, sign * STAGING, _BACK_SPEED, limit=over - clock.now())
                pose = self.navigator.pose()
                if distance((pose.x, pose.y), (dock.pose.x, dock.pose.y)) > dock.radius + _UNDOCKED:
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
