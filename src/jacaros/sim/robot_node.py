"""One robot of the world as it is seen on a ROS graph: its topics.

=========================================== ============================= ==========================
topic (below the robot's namespace)         type                          direction and rate
=========================================== ============================= ==========================
``/odom``                                   ``nav_msgs/msg/Odometry``     out, 20 Hz
``/battery_state``                          ``sensor_msgs/msg/BatteryState`` out, 1 Hz and on changes
``/scan``                                   ``sensor_msgs/msg/LaserScan`` out, 5 Hz when subscribed
``/cmd_vel``, ``/cmd_vel_mux/input/navi``   ``geometry_msgs/msg/Twist``   in, the last message wins
``/cleaning/task``                          ``std_msgs/msg/String``       in, logged with the true pose
``/initialpose``                            ``geometry_msgs/msg/PoseWithCovarianceStamped`` in, for localisation
``/amcl_pose``                              the same                      out, latched, see `jacaros.sim.robot_transforms`
=========================================== ============================= ==========================

Bumpers and the dock are in `jacaros.sim.robot_contacts`, transforms in `jacaros.sim.robot_transforms`, and what the robot
can be asked to do by itself in `jacaros.sim.navigation`.
"""

import math
from typing import Any

from jacaros.ros.backend import Backend, Publisher, Sample, Subscription
from jacaros.ros.message import constant, stamp
from jacaros.sim.navigation.frames import MAP, pose_fault, pose_of
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.robot import Robot
from jacaros.sim.robot_contacts import RobotContacts
from jacaros.sim.robot_transforms import AmclPose, RobotTransforms
from jacaros.sim.trigonometry import sine_cosine
from jacaros.sim.world_time import WorldTime

TICKS_PER_SECOND = 20
_TICKS_PER_SCAN = 4
_TICKS_PER_BATTERY = 20


class RobotNode:
    """The topics of one robot.

    Args:
        time: the world, on a clock.
        robot: which of its robots.
        backend: the graph; it is started already.
    """

    def __init__(self, time: WorldTime, robot: Robot, backend: Backend) -> None:
        self.time, self.robot, self.backend = time, robot, backend
        namespace = robot.description.namespace
        self.prefix = f"/{namespace}" if namespace else ""
        self._frame_prefix = f"{namespace}/" if namespace else ""
        self._ticks = 0
        self._charging: tuple[bool, bool] | None = None
        self._laser_on = robot.description.laser.enabled
        self._odometry = self._publisher("/odom", "nav_msgs/msg/Odometry")
        self._battery = self._publisher("/battery_state", "sensor_msgs/msg/BatteryState")
        self._scan = self._publisher("/scan", "sensor_msgs/msg/LaserScan") if self._laser_on else None
        self.localisation = Localisation(robot)
        self._transforms = RobotTransforms(time, robot, self.localisation, backend)
        self._amcl_pose = AmclPose(time, robot, self.localisation, backend, self.prefix, self._frame_prefix)
        self._contacts = RobotContacts(time, robot, backend, self.prefix, self._frame_prefix)
        self._subscriptions = self._subscribe()

    def _publisher(self, topic: str, type_name: str) -> Publisher:
        # Reliable on purpose: it serves subscriptions that ask for reliable and those that do not.
        return self.backend.publisher(self.prefix + topic, type_name)

    def _subscribe(self) -> list[Subscription]:
        twist, text = "geometry_msgs/msg/Twist", "std_msgs/msg/String"
        return [
            self.backend.subscription(self.prefix + "/cmd_vel", twist, self._command),
            self.backend.subscription(self.prefix + "/cmd_vel_mux/input/navi", twist, self._command),
            self.backend.subscription(self.prefix + "/cleaning/task", text, self._task),
            self.backend.subscription(
                self.prefix + "/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", self._told_pose
            ),
        ]

    def _command(self, sample: Sample) -> None:
        self.time.catch_up()
        twist = sample.message
        self.robot.command(float(twist.linear.x), float(twist.angular.z))

    def _task(self, sample: Sample) -> None:
        self.time.catch_up()
        self.time.world.log_task(self.robot.name, str(sample.message.data))

    def _told_pose(self, sample: Sample) -> None:
        """Somebody says where the robot is, as rviz does; AMCL, too, hears of poses on the map only."""
        header, told = sample.message.header, sample.message.pose
        covariance = [float(value) for value in told.covariance]
        fault = pose_fault(told.pose)
        if header.frame_id.strip("/") not in ("", MAP, self._frame_prefix + MAP):
            fault = f"it must be in the frame '{MAP}', not '{header.frame_id}'"
        if not all(math.isfinite(value) and value >= 0.0 for value in covariance[::7]):
            fault = "its covariance makes no sense"
        if fault is not None:
            self.backend.rosout("warn", f"the pose on {sample.topic} is ignored: {fault}")
            return
        self.time.catch_up()
        radius = 2.0 * math.sqrt(max(covariance[0], covariance[7]))
        turn = 2.0 * math.sqrt(covariance[35])
        self.localisation.believe(pose_of(told.pose), radius, turn, self.time.world.time)

    def publish(self) -> None:
        """Publish what is due at this tick of 20 Hz; the world has caught up."""
        self._publish_odometry()
        self._transforms.publish()
        self._amcl_pose.publish()
        self._contacts.publish(self._ticks)
        battery = self.robot.battery
        charging = (battery.charging, self.robot.dock is not None)
        if self._ticks % _TICKS_PER_BATTERY == 0 or charging != self._charging:
            self._charging = charging
            self._publish_battery()
        if self._scan is not None and self._ticks % _TICKS_PER_SCAN == 0:
            settings = self.robot.description.laser
            if settings.always or self._scan.subscription_count:
                self._publish_scan(self._scan)
        self._ticks += 1

    def _head(self, header: Any, frame: str) -> None:
        stamp(header.stamp, self.time.now())
        header.frame_id = self._frame_prefix + frame

    # Fields are assigned one by one: at twenty messages a second this is five times as fast as making nested
    # messages from keywords, and the world's own steps are cheaper than those would be.

    def _publish_odometry(self) -> None:
        if not self._odometry.subscription_count:
            return
        robot, odometry = self.robot, self.robot.odometry
        message = self._odometry.message()
        self._head(message.header, "odom")
        message.child_frame_id = self._frame_prefix + "base_footprint"
        pose, twist = message.pose.pose, message.twist.twist
        pose.position.x, pose.position.y = odometry.x, odometry.y
        pose.orientation.z, pose.orientation.w = sine_cosine(0.5 * odometry.yaw)
        twist.linear.x, twist.angular.z = robot.speed, robot.turn_rate
        self._odometry.publish(message)

    def _publish_battery(self) -> None:
        battery = self.robot.battery
        message = self._battery.message()
        self._head(message.header, "base_footprint")
        message.voltage, message.percentage = battery.voltage, battery.level / 100.0
        message.current = message.charge = message.capacity = message.design_capacity = float("nan")
        message.present = True
        message.power_supply_status = constant(message, f"POWER_SUPPLY_STATUS_{self._status()}")
        self._battery.publish(message)

    def _status(self) -> str:
        if self.robot.battery.charging:
            return "CHARGING"
        return "FULL" if self.robot.dock is not None else "DISCHARGING"

    def _publish_scan(self, publisher: Publisher) -> None:
        world = self.time.world
        laser = world.laser(self.robot.name)
        message = publisher.message(ranges=world.scan(self.robot.name))
        self._head(message.header, "base_scan")
        message.angle_min, message.angle_max = laser.beams.angle_min, laser.beams.angle_max
        message.angle_increment = laser.beams.angle_increment
        message.scan_time = _TICKS_PER_SCAN / TICKS_PER_SECOND
        message.range_min, message.range_max = laser.settings.range_min, laser.settings.range_max
        publisher.publish(message)

    def close(self) -> None:
        """Leave all topics."""
        for subscription in self._subscriptions:
            subscription.close()
        for publisher in (self._odometry, self._battery, self._scan):
            if publisher is not None:
                publisher.close()
        self._transforms.close()
        self._amcl_pose.close()
        self._contacts.close()
