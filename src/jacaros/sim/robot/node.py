"""The ROS topics of one robot of the world; docs/reference/worlds.md lists them with types and rates.

Navigation and docking are in `jacaros.sim.navigation`.
"""

import math
from collections.abc import Callable, Sequence
from typing import Final

from jacaros.ros.backend import Backend
from jacaros.ros.node import Sample
from jacaros.sim.navigation.frames import MAP, pose_fault, pose_of
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.robot.gripper import Gripper
from jacaros.sim.robot.lights import LightsAndSound
from jacaros.sim.robot.on_graph import RobotOnGraph, Sensor
from jacaros.sim.robot.own_interfaces import OwnInterfaces
from jacaros.sim.robot.robot import Robot
from jacaros.sim.robot.sensors.battery import BatterySensor
from jacaros.sim.robot.sensors.camera import CameraSensor
from jacaros.sim.robot.sensors.cliffs import CliffSensors
from jacaros.sim.robot.sensors.contacts import RobotContacts
from jacaros.sim.robot.sensors.imu import ImuSensor
from jacaros.sim.robot.sensors.laser_scan import LaserSensor
from jacaros.sim.robot.sensors.odometry import OdometrySensor
from jacaros.sim.robot.sensors.recognition import ObjectRecognition
from jacaros.sim.robot.sensors.sonar import SonarSensor
from jacaros.sim.robot.transforms import TYPE as POSE
from jacaros.sim.robot.transforms import AmclPose, RobotTransforms
from jacaros.sim.world_time import WorldTime

SENSORS: Final[Sequence[Callable[[RobotOnGraph], Sensor]]] = (
    OdometrySensor,
    RobotTransforms,
    AmclPose,
    RobotContacts,
    CliffSensors,
    BatterySensor,
    LaserSensor,
    ImuSensor,
    SonarSensor,
    CameraSensor,
    ObjectRecognition,
    OwnInterfaces,
)
"""Sensors of every robot, in publishing order."""

COMMANDS: Final = ("/cmd_vel", "/cmd_vel_mux/input/navi", "/mobile_base/commands/velocity")
"""Topics of velocity commands: those of most robots, of the Kobuki's multiplexer, and of its base."""


class RobotNode:
    """The topics of one robot.

    Args:
        time: the world on a clock.
        robot: robot of that world.
        backend: graph; already started.
        sensors: sensors of the robot.
    """

    def __init__(
        self,
        time: WorldTime,
        robot: Robot,
        backend: Backend,
        sensors: Sequence[Callable[[RobotOnGraph], Sensor]] = SENSORS,
    ) -> None:
        self.time, self.robot, self.backend = time, robot, backend
        self.localisation = Localisation(robot)
        self._at = RobotOnGraph(time, robot, backend, self.localisation)
        self.prefix = self._at.prefix
        self._ticks = 0
        self._sensors = [sensor(self._at) for sensor in sensors]
        for device in (LightsAndSound, Gripper):
            device(self._at)
        for topic in COMMANDS:
            self._at.subscribe(topic, "geometry_msgs/msg/Twist", self._command)
        self._at.subscribe("/cleaning/task", "std_msgs/msg/String", self._task)
        self._at.subscribe("/initialpose", POSE, self._receive_pose)
        if robot.description.tools:
            self._at.subscribe("/cleaning/tool", "std_msgs/msg/String", self._use_tool)

    def _command(self, sample: Sample) -> None:
        self.time.catch_up()
        twist = sample.message
        self.robot.command(float(twist.linear.x), float(twist.angular.z))

    def _task(self, sample: Sample) -> None:
        self.time.catch_up()
        self.time.world.log_task(self.robot.name, str(sample.message.data))

    def _use_tool(self, sample: Sample) -> None:
        self.time.catch_up()
        self.time.world.use_tool(self.robot.name, str(sample.message.data))

    def _receive_pose(self, sample: Sample) -> None:
        """Receive a pose for the robot, for example from rviz; as AMCL does, accept only poses in the map frame."""
        header, received = sample.message.header, sample.message.pose
        covariance = [float(value) for value in received.covariance]
        fault = pose_fault(received.pose)
        if header.frame_id.strip("/") not in ("", MAP, self._at.frame_prefix + MAP):
            fault = f"it must be in the frame '{MAP}', not '{header.frame_id}'"
        if not all(math.isfinite(value) and value >= 0.0 for value in covariance[::7]):
            fault = "its covariance is invalid"
        if fault is not None:
            self.backend.rosout("warn", f"the pose on {sample.topic} is ignored: {fault}")
            return
        self.time.catch_up()
        radius = 2.0 * math.sqrt(max(covariance[0], covariance[7]))
        turn = 2.0 * math.sqrt(covariance[35])
        self.localisation.believe(pose_of(received.pose), radius, turn, self.time.world.time)

    def publish(self) -> None:
        """Publish the sensors that are due at this 20 Hz tick, after the world has caught up."""
        for sensor in self._sensors:
            sensor.publish(self._ticks)
        self._ticks += 1

    def close(self) -> None:
        """Withdraw all topics."""
        self._at.close()
