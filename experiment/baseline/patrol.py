"""Patrol: from corner to corner for a whole shift; when the battery is low, to the dock, and then on to the
corner that the robot was heading for."""

import math
import operator

import py_trees
import rclpy
from action_msgs.msg import GoalStatus
from nav2_msgs.action import NavigateToPose
from nav2_msgs.srv import ClearEntireCostmap
from py_trees.common import ComparisonExpression, Status
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState

CORNERS = ((2.0, 0.0, 0.0), (2.0, 2.0, 90.0), (0.0, 2.0, 180.0), (0.0, 0.0, 270.0))  # metres and degrees
DOCK = (1.0, 1.0, 0.0)
LOW, FULL = 20, 100  # percent


class NavigateTo(py_trees.behaviour.Behaviour):
    """Sends Nav2 to a pose on the map, and is running until Nav2 has finished."""

    def __init__(self, name, client, pose):
        super().__init__(name)
        self.client = client
        self.pose = pose

    def initialise(self):
        x, y, degrees = self.pose
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x, goal.pose.pose.position.y = x, y
        goal.pose.pose.orientation.z = math.sin(math.radians(degrees) / 2)
        goal.pose.pose.orientation.w = math.cos(math.radians(degrees) / 2)
        self.sent = self.client.send_goal_async(goal)
        self.ended = None

    def update(self):
        if not self.sent.done():
            return Status.RUNNING
        if not self.sent.result().accepted:
            return Status.FAILURE
        if self.ended is None:
            self.ended = self.sent.result().get_result_async()
        if not self.ended.done():
            return Status.RUNNING
        succeeded = self.ended.result().status == GoalStatus.STATUS_SUCCEEDED
        return Status.SUCCESS if succeeded else Status.FAILURE

    def terminate(self, new_status):
        # A behaviour of higher priority has interrupted this one, perhaps before Nav2 has accepted the goal.
        if self.status == Status.RUNNING and new_status == Status.INVALID:
            self.sent.add_done_callback(
                lambda sent: sent.result().accepted and sent.result().cancel_goal_async()
            )


class ClearCostmap(py_trees.behaviour.Behaviour):
    """Lets Nav2 forget the obstacles that it has seen so far."""

    def __init__(self, name, client):
        super().__init__(name)
        self.client = client

    def update(self):
        if self.client.service_is_ready():
            self.client.call_async(ClearEntireCostmap.Request())
        return Status.SUCCESS


class Report(py_trees.behaviour.Behaviour):
    """Calls a function when the tree has come this far."""

    def __init__(self, name, function):
        super().__init__(name)
        self.function = function

    def update(self):
        self.function()
        return Status.SUCCESS


class Patrol(Node):
    """Ticks the tree ten times a second, and puts the battery on its blackboard."""

    def __init__(self):
        super().__init__("patrol")
        self.recharges = 0
        self.shift = self.declare_parameter("shift", 10).value  # recharges
        self.attempts = self.declare_parameter("attempts", 20).value  # so often a way is tried
        self.pause = self.declare_parameter("pause", 2.0).value  # seconds between two attempts
        self.charged_within = self.declare_parameter("charged_within", 60.0).value  # seconds in the dock
        self.nav2 = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self.costmap = self.create_client(ClearEntireCostmap, "global_costmap/clear_entirely_global_costmap")
        self.blackboard = py_trees.blackboard.Client(name="patrol")
        self.blackboard.register_key("battery", access=py_trees.common.Access.WRITE)
        self.blackboard.battery = FULL
        self.tree = py_trees.trees.BehaviourTree(self.create_root())
        self.create_subscription(BatteryState, "battery_state", self.on_battery, qos_profile_sensor_data)
        self.create_timer(0.1, self.tick)

    def create_root(self):
        corners = [self.create_corner(number, pose) for number, pose in enumerate(CORNERS, 1)]
        patrol = py_trees.idioms.pick_up_where_you_left_off("Round", corners)
        return py_trees.composites.Sequence(
            "Shift",
            memory=False,
            children=[
                self.create_energy(),
                py_trees.decorators.Repeat("Rounds", patrol, num_success=-1),
            ],
        )

    def create_energy(self):
        """Whatever the robot is doing: when the battery is low, it charges until the battery is full."""
        enough = ComparisonExpression("battery", LOW, operator.gt)
        full = ComparisonExpression("battery", FULL, operator.ge)
        charge = py_trees.behaviours.WaitForBlackboardVariableValue("Until full", full)
        recharge = py_trees.composites.Sequence(
            "Recharge",
            memory=True,
            children=[
                self.navigate_to("dock", DOCK),
                Report("In the dock", lambda: self.get_logger().info("dock")),
                py_trees.decorators.Timeout("A full battery", charge, self.charged_within),
                Report("Charged", self.charged),
            ],
        )
        check = py_trees.behaviours.CheckBlackboardVariableValue("Enough?", enough)
        # With memory, a recharge continues although the battery is no longer low.
        return py_trees.composites.Selector("Energy", memory=True, children=[check, recharge])

    def create_corner(self, number, pose):
        name = f"Corner {number}"
        arrived = Report("Arrived", lambda: self.arrived(number))
        return py_trees.composites.Sequence(
            name, memory=True, children=[self.navigate_to(name, pose), arrived]
        )

    def navigate_to(self, name, pose):
        """Try again after a pause, in which Nav2 forgets obstacles that may have moved."""
        again = py_trees.composites.Sequence(
            f"{name} again",
            memory=True,
            children=[
                ClearCostmap("Clear", self.costmap),
                py_trees.timers.Timer("Pause", self.pause),
                self.create_way(name, pose),
            ],
        )
        retry = py_trees.decorators.Retry(f"Retry {name}", again, self.attempts - 1)
        return py_trees.composites.Selector(
            f"To {name}", memory=True, children=[self.create_way(name, pose), retry]
        )

    def create_way(self, name, pose):
        return NavigateTo(name, self.nav2, pose)

    def tick(self):
        if not self.nav2.server_is_ready():
            return
        self.tree.tick()
        if self.tree.root.status == Status.FAILURE:
            self.get_logger().error(f"I need help: {self.tree.tip().name} cannot be reached")
            raise SystemExit(1)

    def on_battery(self, message):
        self.blackboard.battery = int(100 * message.percentage)

    def arrived(self, corner):
        self.get_logger().info(f"corner {corner}")
        if self.recharges >= self.shift:
            raise SystemExit

    def charged(self):
        self.recharges += 1


def main():
    rclpy.init()
    rclpy.spin(Patrol())


if __name__ == "__main__":
    main()
