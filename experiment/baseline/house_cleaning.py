"""House cleaning: from room to room, in each room the tasks of that room; when the battery is low, even in the
middle of a task, to the dock, back into the room, and on."""

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
from std_msgs.msg import String

ROOMS = {  # where to go, in metres, and the tasks there with their seconds
    "living room": ((2.0, 0.0), {"vacuum carpet": 2.5}),
    "kitchen": ((2.0, 2.0), {"mop floor": 2.5}),
    "bathroom": ((0.0, 2.0), {"scrub tub": 1.0, "mop floor": 2.5}),
}
HALLWAY = (0.0, 0.0)
DOCK = (1.0, 1.0)
ROUNDS = 4
LOW, FULL = 20, 100  # percent
PERIOD = 0.1  # seconds between two ticks


class NavigateTo(py_trees.behaviour.Behaviour):
    """Sends Nav2 to a place on the map, and is running until Nav2 has finished."""

    def __init__(self, name, client, place):
        super().__init__(name)
        self.client = client
        self.place = place

    def initialise(self):
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x, goal.pose.pose.position.y = self.place
        goal.pose.pose.orientation.w = 1.0
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


class CleaningTask(py_trees.behaviour.Behaviour):
    """Cleans for some seconds; after an interruption it continues with the remaining time."""

    def __init__(self, name, node, task, seconds):
        super().__init__(name)
        self.node = node
        self.task = task
        self.ticks = round(seconds / PERIOD)
        self.left = self.ticks

    def initialise(self):
        if self.left == self.ticks:
            self.node.get_logger().info(self.task)
            self.node.tasks.publish(String(data=self.task))
        else:
            self.node.tools.publish(String(data=self.task.split()[0]))

    def update(self):
        self.left -= 1
        return Status.RUNNING if self.left >= 0 else Status.SUCCESS

    def terminate(self, new_status):
        if self.status == Status.RUNNING or new_status == Status.SUCCESS:
            self.node.tools.publish(String(data=""))


class Log(py_trees.behaviour.Behaviour):
    """Logs its name."""

    def __init__(self, name, node):
        super().__init__(name)
        self.node = node

    def update(self):
        self.node.get_logger().info(self.name)
        return Status.SUCCESS


class HouseCleaning(Node):
    """Ticks the tree, and puts the battery on its blackboard."""

    def __init__(self):
        super().__init__("house_cleaning")
        self.attempts = self.declare_parameter("attempts", 20).value  # so often a way is tried
        self.pause = self.declare_parameter("pause", 2.0).value  # seconds between two attempts
        self.charged_within = self.declare_parameter("charged_within", 60.0).value  # seconds in the dock
        self.nav2 = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self.costmap = self.create_client(ClearEntireCostmap, "global_costmap/clear_entirely_global_costmap")
        self.tasks = self.create_publisher(String, "cleaning/task", 10)
        self.tools = self.create_publisher(String, "cleaning/tool", 10)
        self.blackboard = py_trees.blackboard.Client(name="house_cleaning")
        self.blackboard.register_key("battery", access=py_trees.common.Access.WRITE)
        self.blackboard.battery = FULL
        self.tree = py_trees.trees.BehaviourTree(self.create_root())
        self.create_subscription(BatteryState, "battery_state", self.on_battery, qos_profile_sensor_data)
        self.create_timer(PERIOD, self.tick)

    def create_root(self):
        # One sequence of all rounds: a decorator Repeat would forget its count when the battery interrupts it.
        rooms = []
        for number in range(1, ROUNDS + 1):
            rooms += [self.create_room(f"{room} {number}", room, *ROOMS[room]) for room in ROOMS]
            rooms += [self.navigate_to(f"hallway {number}", HALLWAY), Log("hallway", self)]
        clean = py_trees.idioms.pick_up_where_you_left_off("Clean", rooms)
        return py_trees.composites.Sequence("House", memory=False, children=[self.create_energy(), clean])

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
                Log("dock", self),
                py_trees.decorators.Timeout("A full battery", charge, self.charged_within),
            ],
        )
        check = py_trees.behaviours.CheckBlackboardVariableValue("Enough?", enough)
        # With memory, a recharge continues although the battery is no longer low.
        return py_trees.composites.Selector("Energy", memory=True, children=[check, recharge])

    def create_room(self, name, room, place, tasks):
        """After an interruption, the robot drives back into the room and continues with the task."""
        work = [
            CleaningTask(f"{task} {name}", self, f"{task} {room.replace(' ', '_')}", seconds)
            for task, seconds in tasks.items()
        ]
        work = py_trees.idioms.pick_up_where_you_left_off(f"work {name}", work)
        return py_trees.composites.Sequence(
            name, memory=True, children=[self.navigate_to(f"to {name}", place), work]
        )

    def navigate_to(self, name, place):
        """Try again after a pause, in which Nav2 forgets obstacles that may have moved."""
        again = py_trees.composites.Sequence(
            f"{name} again",
            memory=True,
            children=[
                ClearCostmap("Clear", self.costmap),
                py_trees.timers.Timer("Pause", self.pause),
                self.create_way(name, place),
            ],
        )
        retry = py_trees.decorators.Retry(f"Retry {name}", again, self.attempts - 1)
        return py_trees.composites.Selector(
            f"To {name}", memory=True, children=[self.create_way(name, place), retry]
        )

    def create_way(self, name, place):
        return NavigateTo(name, self.nav2, place)

    def tick(self):
        if not (self.nav2.server_is_ready() and self.tasks.get_subscription_count()):
            return
        self.tree.tick()
        if self.tree.root.status == Status.SUCCESS:
            raise SystemExit
        if self.tree.root.status == Status.FAILURE:
            self.get_logger().error(f"I need help: {self.tree.tip().name} cannot be reached")
            raise SystemExit(1)

    def on_battery(self, message):
        self.blackboard.battery = int(100 * message.percentage)


def main():
    rclpy.init()
    rclpy.spin(HouseCleaning())


if __name__ == "__main__":
    main()
