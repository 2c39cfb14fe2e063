"""States that the patrol and the house cleaning of YASMIN share: to drive by Nav2, to pause, to charge."""

import math
import time
from threading import Event

from nav2_msgs.action import NavigateToPose
from nav2_msgs.srv import ClearEntireCostmap
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState
from yasmin import CbState, State, StateMachine
from yasmin_ros import ActionState, MonitorState, ServiceState
from yasmin_ros.basic_outcomes import ABORT, CANCEL, RETRY, SUCCEED
from yasmin_ros.yasmin_node import YasminNode

LOW, FULL = 20, 100  # percent
CHARGED, CHARGING = "charged", "charging"


class NavigateState(ActionState):
    """Drives to the pose on the blackboard: metres and degrees."""

    def __init__(self):
        super().__init__(NavigateToPose, "navigate_to_pose", self.create_goal)

    def create_goal(self, blackboard):
        x, y, degrees = blackboard["pose"]
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x, goal.pose.pose.position.y = x, y
        goal.pose.pose.orientation.z = math.sin(math.radians(degrees) / 2)
        goal.pose.pose.orientation.w = math.cos(math.radians(degrees) / 2)
        return goal


class ClearCostmapState(ServiceState):
    """Lets Nav2 forget the obstacles that it has seen so far."""

    def __init__(self):
        super().__init__(
            ClearEntireCostmap,
            "global_costmap/clear_entirely_global_costmap",
            lambda blackboard: ClearEntireCostmap.Request(),
        )


class PauseState(State):
    """Gives obstacles time to move."""

    def __init__(self):
        super().__init__([SUCCEED, CANCEL])
        self.canceled = Event()

    def execute(self, blackboard):
        self.canceled.clear()
        return CANCEL if self.canceled.wait(blackboard["pause"]) else SUCCEED

    def cancel_state(self):
        self.canceled.set()
        super().cancel_state()


class ChargeState(MonitorState):
    """Looks at the next message of the battery; aborts if it takes too long until it is full."""

    def __init__(self):
        super().__init__(
            BatteryState,
            "battery_state",
            [CHARGED, CHARGING, ABORT],
            self.look,
            qos=qos_profile_sensor_data,
            msg_queue=1,
        )

    def look(self, blackboard, message):
        if message.percentage * 100 >= FULL:
            return CHARGED
        waited = time.monotonic() - blackboard["docked_at"]
        return CHARGING if waited < blackboard["charged_within"] else ABORT


class Drive(StateMachine):
    """Drives to the pose on the blackboard, in as many attempts as allowed."""

    def __init__(self):
        super().__init__(outcomes=[SUCCEED, CANCEL, ABORT])
        self.navigating, self.pausing = NavigateState(), PauseState()
        self.add_state("STARTING", CbState([SUCCEED], start), {SUCCEED: "NAVIGATING"})
        self.add_state("NAVIGATING", self.navigating, {SUCCEED: SUCCEED, CANCEL: CANCEL, ABORT: "RETRYING"})
        self.add_state("RETRYING", CbState([RETRY, ABORT], retry), {RETRY: "CLEARING", ABORT: ABORT})
        self.add_state("CLEARING", ClearCostmapState(), {SUCCEED: "PAUSING", ABORT: "PAUSING"})
        self.add_state("PAUSING", self.pausing, {SUCCEED: "NAVIGATING", CANCEL: CANCEL})


def start(blackboard):
    blackboard["attempts_left"] = blackboard["attempts"]
    return SUCCEED


def retry(blackboard):
    blackboard["attempts_left"] -= 1
    return RETRY if blackboard["attempts_left"] else ABORT


class Battery:
    """Puts the level on the blackboard, and cancels the running one of some states when it is low."""

    def __init__(self, blackboard, states):
        self.blackboard, self.states = blackboard, states
        blackboard["battery"], blackboard["recharging"] = FULL, False
        # With a group of its own, a callback can wait until Nav2 has answered that it cancels a goal.
        YasminNode.get_instance().create_subscription(
            BatteryState,
            "battery_state",
            self.on_battery,
            qos_profile_sensor_data,
            callback_group=ReentrantCallbackGroup(),
        )

    def on_battery(self, message):
        level = int(100 * message.percentage)
        self.blackboard["battery"] = level
        if level > LOW or self.blackboard["recharging"]:
            return
        for state in self.states:
            if state.is_running() or state.is_canceled():  # cancelled, but Nav2 had not accepted the goal yet
                state.cancel_state()
