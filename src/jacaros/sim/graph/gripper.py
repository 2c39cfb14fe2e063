"""The gripper of a robot: ``/gripper_controller/gripper_cmd`` (``control_msgs/action/GripperCommand``).

As with ros2_control's gripper controller, a goal succeeds when the fingers have reached their position (``reached_goal``)
or when an object between them stops them (``stalled``), and a newer goal preempts an older one.
"""

import math
from collections.abc import Mapping
from typing import Any, Final

from jacaros.sim.graph.on_graph import Goal, RobotOnGraph
from jacaros.sim.objects import Thing
from jacaros.sim.robot.motion import approach

OPENING: Final = 0.1
"""Metres between the open fingers, which is their initial position."""
_SPEED = 0.1
_PERIOD = 0.1


def offer_gripper(at: RobotOnGraph) -> None:
    """Offer the gripper of a robot, if it has one."""
    if at.robot.description.gripper_reach:
        name = "/gripper_controller/gripper_cmd"
        at.action(name, "control_msgs/action/GripperCommand", _Gripper(at).move, _refuse)


class _Gripper:
    """Moves the fingers of one robot, and picks up and puts down objects."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at, self._objects = at, at.time.world.objects
        self._opening = OPENING

    async def move(self, goal: Goal) -> Mapping[str, Any]:
        wanted = min(max(float(goal.request.command.position), 0.0), OPENING)
        stalled = False
        while not stalled and self._opening != wanted:
            await self._at.time.clock.sleep(_PERIOD)
            self._at.time.catch_up()
            stalled = self._step(wanted)
            goal.feedback(**self._state(wanted, stalled))
        return self._state(wanted, stalled)

    def _state(self, wanted: float, stalled: bool) -> dict[str, Any]:
        return {"position": self._opening, "stalled": stalled, "reached_goal": self._opening == wanted}

    def _step(self, wanted: float) -> bool:
        """Move the fingers towards *wanted* for one period; return whether something stops them."""
        robot = self._at.robot
        held = self._objects.held_by(robot)
        opening = approach(self._opening, wanted, _SPEED * _PERIOD)
        if held is None:
            found = self._between(opening)
            if found is not None:
                self._opening = found.width
                self._objects.pick(robot, found)
                return True
        elif opening < self._opening:
            return True
        else:
            self._objects.put_down(robot, held)
        self._opening = opening
        return False

    def _between(self, opening: float) -> Thing | None:
        """Return the object that the closing fingers meet on their way to *opening*."""
        if opening >= self._opening:
            return None
        found = self._objects.before(self._at.robot)
        return found if found is not None and opening <= found.width <= self._opening else None


def _refuse(request: Any) -> str | None:
    return None if math.isfinite(request.command.position) else "the position is not a finite number"
