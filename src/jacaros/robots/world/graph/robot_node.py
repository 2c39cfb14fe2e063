"""The ROS interfaces of one robot of the world; docs/reference/worlds.md lists them with types and rates.

Navigation and docking are in `jacaros.robots.world.navigation`.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

from jacaros.robots.plane.pose import Placement, Pose
from jacaros.robots.ros.backend import Backend, Sample
from jacaros.robots.ros.errors import MessageMismatch, UnknownInterface
from jacaros.robots.ros.message import plain, to_seconds
from jacaros.robots.ros.names import response_type
from jacaros.robots.world.data.robot import Added, absolute
from jacaros.robots.world.graph.frames import MAP, POSE_WITH_COVARIANCE, pose_fault, pose_of
from jacaros.robots.world.graph.on_graph import TICKS_PER_SECOND, ActiveGoal, RobotOnGraph, WorldTime
from jacaros.robots.world.graph.publishing import Tick
from jacaros.robots.world.graph.sensors import SENSORS
from jacaros.robots.world.physics.localisation import SimulatedLocalisation
from jacaros.robots.world.physics.robot import Robot, approach
from jacaros.robots.world.physics.things import Thing
from jacaros.runtime.errors import UsageError

COMMANDS: Final = ("/cmd_vel", "/cmd_vel_mux/input/navi", "/mobile_base/commands/velocity")
"""Topics of velocity commands: those of most robots, of the Kobuki's multiplexer, and of its base."""


class RobotNode(RobotOnGraph):
    """One robot with its sensors and commands, and the topics and services that a world file adds to it.

    Raises:
        UsageError: an added type is not installed, or does not have the fields that the world file states.
    """

    def __init__(
        self, time: WorldTime, robot: Robot, backend: Backend, localisation: SimulatedLocalisation
    ) -> None:
        super().__init__(time, robot, backend, localisation)
        self._ticks = 0
        self._sensors: list[Tick] = [sensor(self) for sensor in SENSORS]
        self._colors: list[str] = []
        interface = robot.description.interface
        self._add(interface.topics, self._add_topic)
        self._add(interface.services, self._add_service)
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

    def _add(self, each_added: Iterable[Added], add: Callable[[Added, str], None]) -> None:
        for added in each_added:
            try:
                add(added, absolute(added.name, self.prefix))
            except (UnknownInterface, MessageMismatch) as error:
                raise UsageError(f"`{added.name}` of the robot `{self.robot.name}`: {error}") from None

    def _add_service(self, service: Added, name: str) -> None:
        """Offer a service of a world file with a constant response."""
        self.backend.message(response_type(service.type_name), **service.fields)  # finds mistakes
        self.keep(self.backend.service(name, service.type_name, lambda request: service.fields))

    def _add_topic(self, topic: Added, name: str) -> None:
        """Publish the constant message of a topic of a world file, or record the messages that it receives."""
        if not topic.rate:
            self.keep(self.backend.subscription(name, topic.type_name, self._record))
            return
        publisher = self.keep(self.backend.publisher(name, topic.type_name))
        publisher.message(**topic.fields)  # finds mistakes
        period = max(1, round(TICKS_PER_SECOND / topic.rate))

        def publish(ticks: int) -> None:
            if ticks % period == 0:
                message = publisher.message(**topic.fields)
                if hasattr(message, "header"):
                    self.fill_header(message.header, message.header.frame_id or "base_link")
                publisher.publish(message)

        self._sensors.append(publish)

    def _record(self, sample: Sample) -> None:
        self.time.catch_up()
        self.robot.tell("received", {"topic": sample.topic, "message": plain(sample.message)})

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
