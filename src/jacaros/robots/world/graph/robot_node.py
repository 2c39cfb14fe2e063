"""The ROS interfaces of one robot of the world; docs/reference/worlds.md lists them with types and rates.

Navigation and docking are in `jacaros.robots.world.navigation`.
"""

import math
from collections.abc import Mapping
from typing import Any, Final

from jacaros.robots.plane.pose import Placement, Pose
from jacaros.robots.ros.backend import Backend, Sample
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.world.graph.frames import MAP, POSE_WITH_COVARIANCE, pose_fault, pose_of
from jacaros.robots.world.graph.on_graph import ActiveGoal, RobotOnGraph, WorldTime
from jacaros.robots.world.graph.publishing import Tick
from jacaros.robots.world.graph.sensors import SENSORS
from jacaros.robots.world.physics.localisation import SimulatedLocalisation
from jacaros.robots.world.physics.robot import Robot, approach
from jacaros.robots.world.physics.things import Thing

COMMANDS: Final = ("/cmd_vel", "/cmd_vel_mux/input/navi", "/mobile_base/commands/velocity")
"""Topics of velocity commands: those of most robots, of the Kobuki's multiplexer, and of its base."""


class RobotNode(RobotOnGraph):
    """One robot with its sensors and commands."""

    def __init__(
        self, time: WorldTime, robot: Robot, backend: Backend, localisation: SimulatedLocalisation
    ) -> None:
        super().__init__(time, robot, backend, localisation)
        self._ticks = 0
        self._sensors: list[Tick] = [sensor(self) for sensor in SENSORS]
        self._colors: list[str] = []
        self.subscribe("/cmd_lightring", "irobot_create_msgs/msg/LightringLeds", self._light)
        self.subscribe("/cmd_audio", "irobot_create_msgs/msg/AudioNoteVector", self._play)
        if robot.description.gripper_reach:
            name = "/gripper_controller/gripper_cmd"
            self.action(name, "control_msgs/action/GripperCommand", _Gripper(self).move, _refuse)
        for topic in COMMANDS:
            self.subscribe(topic, "geometry_msgs/msg/Twist", self._command)
        self.subscribe("/cleaning/task", "std_msgs/msg/String", self._task)
        self.subscribe("/initialpose", POSE_WITH_COVARIANCE, self._receive_pose)
        if backend.ros_version == 2:
            self.service("/reinitialize_global_localization", "std_srvs/srv/Empty", self._relocalise)
        if backend.ros_version == 1 or backend.name == "memory":
            self.service("/global_localization", "std_srvs/srv/Empty", self._relocalise)
        if robot.description.tools:
            self.subscribe("/cleaning/tool", "std_msgs/msg/String", self._use_tool)

    def publish(self) -> None:
        """Publish the sensors that are due at this 20 Hz tick, after the world has caught up."""
        if self.robot.misled is not None:
            self._mislead(self.robot.misled)
        for sensor in self._sensors:
            sensor(self._ticks)
        self._ticks += 1

    def _mislead(self, pose: Pose) -> None:
        """Let the estimated pose jump to another; as after a robot was put down, nothing tells the robot."""
        self.robot.misled = None
        self.localisation.map_to_odom = Placement.at(*pose).then(self.robot.odometry.placement.inverse())
        self.robot.put_downs += 1

    def _light(self, sample: Sample) -> None:
        """Record colours as ``#rrggbb``, counter-clockwise from the front; none if the robot controls its lights."""
        leds = sample.message.leds if sample.message.override_system else ()
        colors = [f"#{led.red:02x}{led.green:02x}{led.blue:02x}" for led in leds]
        if colors != self._colors:
            self._colors = colors
            self.robot.tell("lights", {"colors": colors})

    def _play(self, sample: Sample) -> None:
        """Record notes as pairs of frequency (Hz) and duration (s)."""
        notes = [[int(note.frequency), to_seconds(note.max_runtime)] for note in sample.message.notes]
        self.robot.tell("sound", {"notes": notes, "append": bool(sample.message.append)})

    def _command(self, sample: Sample) -> None:
        twist: Any = sample.message
        self.robot.command(float(twist.linear.x), float(twist.angular.z))

    def _task(self, sample: Sample) -> None:
        self.time.world.log_task(self.robot.name, str(sample.message.data))

    def _use_tool(self, sample: Sample) -> None:
        self.time.world.use_tool(self.robot.name, str(sample.message.data))

    def _receive_pose(self, sample: Sample) -> None:
        """Receive a pose for the robot, for example from rviz; as AMCL does, accept only poses in the map frame."""
        header, received = sample.message.header, sample.message.pose
        covariance = [float(value) for value in received.covariance]
        fault = pose_fault(received.pose)
        if header.frame_id.strip("/") not in ("", MAP, self.frame_prefix + MAP):
            fault = f"it must be in the frame '{MAP}', not '{header.frame_id}'"
        if not all(math.isfinite(value) and value >= 0.0 for value in covariance[::7]):
            fault = "its covariance is invalid"
        if fault is not None:
            self.backend.rosout("warn", f"the pose on {sample.topic} is ignored: {fault}")
            return
        radius = 2.0 * math.sqrt(max(covariance[0], covariance[7]))
        turn = 2.0 * math.sqrt(covariance[35])
        self.localisation.believe(pose_of(received.pose), radius, turn, self.time.world.time)

    def _relocalise(self, request: Any) -> Mapping[str, Any]:
        self.time.catch_up()
        self.localisation.relocalise()
        return {}


OPENING: Final = 0.1
"""Metres between the open fingers, which is their initial position."""
_SPEED = 0.1
_PERIOD = 0.1


class _Gripper:
    """Moves the fingers of one robot, and picks up and puts down objects.

    As with ros2_control's gripper controller, a goal succeeds when the fingers have reached their position
    (``reached_goal``) or when an object between them stops them (``stalled``), and a newer goal preempts an older one.
    """

    def __init__(self, at: RobotOnGraph) -> None:
        self._at, self._objects = at, at.time.world.objects
        self._opening = OPENING
        self._misses = False

    async def move(self, goal: ActiveGoal) -> Mapping[str, Any]:
        wanted = min(max(float(goal.request.command.position), 0.0), OPENING)
        stalled, misses = False, self._at.robot.misses
        self._misses = wanted < self._opening and misses is not None and misses()
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
        if opening >= self._opening or self._misses:
            return None
        found = self._objects.before(self._at.robot)
        return found if found is not None and opening <= found.width <= self._opening else None


def _refuse(request: Any) -> str | None:
    return None if math.isfinite(request.command.position) else "the position is not a finite number"
