"""House cleaning with YASMIN: from room to room, in each room the tasks of that room; when the battery is low, even
in the middle of a task, to the dock, back into the room, and on."""

import sys
import time
from threading import Event

import rclpy
import yasmin
from std_msgs.msg import String
from yasmin import Blackboard, CbState, State, StateMachine
from yasmin_ros import GetParametersState, set_ros_loggers
from yasmin_ros.basic_outcomes import ABORT, CANCEL, SUCCEED
from yasmin_ros.yasmin_node import YasminNode
from yasmin_states import CHARGED, CHARGING, LOW, Battery, ChargeState, Drive

PLACES = {  # where to go, in metres and degrees, and the tasks there with their seconds
    "living_room": ((2.0, 0.0, 0.0), {"vacuum carpet": 2.5}),
    "kitchen": ((2.0, 2.0, 0.0), {"mop floor": 2.5}),
    "bathroom": ((0.0, 2.0, 0.0), {"scrub tub": 1.0, "mop floor": 2.5}),
    "hallway": ((0.0, 0.0, 0.0), {}),
}
DOCK = (1.0, 1.0, 0.0)
ROUNDS = 4
PARAMETERS = {
    "attempts": 20,  # to reach a place
    "pause": 2.0,  # seconds between two attempts
    "charged_within": 60.0,  # seconds in the dock
}
BATTERY_LOW, BATTERY_OK, HAS_NEXT, END = "battery_low", "battery_ok", "has_next", "end"


class CleaningState(State):
    """Does the tasks of the place; after an interruption it continues with the remaining time."""

    def __init__(self):
        super().__init__([SUCCEED, CANCEL])
        self.canceled = Event()
        node = YasminNode.get_instance()
        self.tasks = node.create_publisher(String, "cleaning/task", 10)
        self.tools = node.create_publisher(String, "cleaning/tool", 10)

    def execute(self, blackboard):
        self.canceled.clear()
        place, left = blackboard["places"][0], blackboard["seconds_left"]
        for task in PLACES[place][1]:
            if left[task] > 0 and not self.clean(task, place, left):
                return CANCEL
        return SUCCEED

    def clean(self, task, place, left):
        if left[task] == PLACES[place][1][task]:
            yasmin.YASMIN_LOG_INFO(f"{task} {place}")
            self.tasks.publish(String(data=f"{task} {place}"))
        else:
            self.tools.publish(String(data=task.split()[0]))
        began = time.monotonic()
        canceled = self.canceled.wait(left[task])
        left[task] -= time.monotonic() - began
        self.tools.publish(String(data=""))
        return not canceled

    def cancel_state(self):
        self.canceled.set()
        super().cancel_state()


def enter(blackboard):
    place = blackboard["places"][0]
    blackboard["seconds_left"] = dict(PLACES[place][1])
    return SUCCEED


def check_battery(blackboard):
    if blackboard["battery"] > LOW:
        blackboard["pose"] = PLACES[blackboard["places"][0]][0]
        return BATTERY_OK
    blackboard["pose"], blackboard["recharging"] = DOCK, True
    return BATTERY_LOW


def leave(blackboard):
    if blackboard["places"].pop(0) == "hallway":
        yasmin.YASMIN_LOG_INFO("hallway")
    return HAS_NEXT if blackboard["places"] else END


def dock(blackboard):
    yasmin.YASMIN_LOG_INFO("dock")
    blackboard["docked_at"] = time.monotonic()
    return SUCCEED


def end_charging(blackboard):
    blackboard["recharging"] = False
    return SUCCEED


def create_cleaning(blackboard):
    drive, cleaning = Drive(), CleaningState()
    Battery(blackboard, [drive.navigating, drive.pausing, cleaning])
    house = StateMachine(outcomes=[SUCCEED, ABORT])
    house.add_state("GETTING_PARAMETERS", GetParametersState(PARAMETERS), {SUCCEED: "ENTERING", ABORT: ABORT})
    house.add_state("ENTERING", CbState([SUCCEED], enter), {SUCCEED: "CHECKING_BATTERY"})
    house.add_state(
        "CHECKING_BATTERY",
        CbState([BATTERY_OK, BATTERY_LOW], check_battery),
        {BATTERY_OK: "DRIVING_TO_ROOM", BATTERY_LOW: "DRIVING_TO_DOCK"},
    )
    house.add_state("DRIVING_TO_ROOM", drive, {SUCCEED: "CLEANING", CANCEL: "CHECKING_BATTERY", ABORT: ABORT})
    house.add_state("CLEANING", cleaning, {SUCCEED: "LEAVING", CANCEL: "CHECKING_BATTERY"})
    house.add_state("LEAVING", CbState([HAS_NEXT, END], leave), {HAS_NEXT: "ENTERING", END: SUCCEED})
    house.add_state("DRIVING_TO_DOCK", drive, {SUCCEED: "DOCKING", CANCEL: "DRIVING_TO_DOCK", ABORT: ABORT})
    house.add_state("DOCKING", CbState([SUCCEED], dock), {SUCCEED: "CHARGING"})
    house.add_state(
        "CHARGING",
        ChargeState(),
        {CHARGED: "RETURNING", CHARGING: "CHARGING", CANCEL: "CHARGING", ABORT: ABORT},
    )
    house.add_state("RETURNING", CbState([SUCCEED], end_charging), {SUCCEED: "CHECKING_BATTERY"})
    return house


def main():
    rclpy.init()
    set_ros_loggers()
    blackboard = Blackboard({"places": [*PLACES] * ROUNDS})
    outcome = create_cleaning(blackboard)(blackboard)
    if outcome != SUCCEED:
        yasmin.YASMIN_LOG_ERROR(f"I need help: {blackboard['pose']} or a full battery cannot be reached")
    rclpy.shutdown()
    sys.exit(outcome != SUCCEED)


if __name__ == "__main__":
    main()
