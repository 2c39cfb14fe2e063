"""Patrol with YASMIN: from corner to corner for a whole shift; when the battery is low, to the dock, and then on
to the corner that the robot was heading for."""

import sys
import time

import rclpy
import yasmin
from yasmin import Blackboard, CbState, StateMachine
from yasmin_ros import GetParametersState, set_ros_loggers
from yasmin_ros.basic_outcomes import ABORT, CANCEL, SUCCEED
from yasmin_states import CHARGED, CHARGING, LOW, Battery, ChargeState, Drive

CORNERS = ((2.0, 0.0, 0.0), (2.0, 2.0, 90.0), (0.0, 2.0, 180.0), (0.0, 0.0, 270.0))  # metres and degrees
DOCK = (1.0, 1.0, 0.0)
PARAMETERS = {
    "attempts": 20,  # to reach a place
    "pause": 2.0,  # seconds between two attempts
    "charged_within": 60.0,  # seconds in the dock
    "shift": 10,  # recharges after which it ends
}
BATTERY_LOW, BATTERY_OK, HAS_NEXT, END = "battery_low", "battery_ok", "has_next", "end"


def check_battery(blackboard):
    if blackboard["battery"] > LOW:
        blackboard["pose"] = CORNERS[blackboard["corner"]]
        return BATTERY_OK
    blackboard["pose"], blackboard["recharging"] = DOCK, True
    return BATTERY_LOW


def arrive(blackboard):
    yasmin.YASMIN_LOG_INFO(f"corner {blackboard['corner'] + 1}")
    blackboard["corner"] = (blackboard["corner"] + 1) % len(CORNERS)
    return END if blackboard["recharges"] >= blackboard["shift"] else HAS_NEXT


def dock(blackboard):
    yasmin.YASMIN_LOG_INFO("dock")
    blackboard["docked_at"] = time.monotonic()
    return SUCCEED


def end_charging(blackboard):
    blackboard["recharges"] += 1
    blackboard["recharging"] = False
    return SUCCEED


def create_patrol(blackboard):
    drive = Drive()
    Battery(blackboard, [drive.navigating, drive.pausing])
    patrol = StateMachine(outcomes=[SUCCEED, ABORT])
    patrol.add_state(
        "GETTING_PARAMETERS", GetParametersState(PARAMETERS), {SUCCEED: "CHECKING_BATTERY", ABORT: ABORT}
    )
    patrol.add_state(
        "CHECKING_BATTERY",
        CbState([BATTERY_OK, BATTERY_LOW], check_battery),
        {BATTERY_OK: "DRIVING_TO_CORNER", BATTERY_LOW: "DRIVING_TO_DOCK"},
    )
    patrol.add_state(
        "DRIVING_TO_CORNER", drive, {SUCCEED: "ARRIVING", CANCEL: "CHECKING_BATTERY", ABORT: ABORT}
    )
    patrol.add_state(
        "ARRIVING", CbState([HAS_NEXT, END], arrive), {HAS_NEXT: "CHECKING_BATTERY", END: SUCCEED}
    )
    patrol.add_state("DRIVING_TO_DOCK", drive, {SUCCEED: "DOCKING", CANCEL: "DRIVING_TO_DOCK", ABORT: ABORT})
    patrol.add_state("DOCKING", CbState([SUCCEED], dock), {SUCCEED: "CHARGING"})
    patrol.add_state(
        "CHARGING",
        ChargeState(),
        {CHARGED: "RETURNING", CHARGING: "CHARGING", CANCEL: "CHARGING", ABORT: ABORT},
    )
    patrol.add_state("RETURNING", CbState([SUCCEED], end_charging), {SUCCEED: "CHECKING_BATTERY"})
    return patrol


def main():
    rclpy.init()
    set_ros_loggers()
    blackboard = Blackboard({"corner": 0, "recharges": 0})
    outcome = create_patrol(blackboard)(blackboard)
    if outcome != SUCCEED:
        yasmin.YASMIN_LOG_ERROR(f"I need help: {blackboard['pose']} or a full battery cannot be reached")
    rclpy.shutdown()
    sys.exit(outcome != SUCCEED)


if __name__ == "__main__":
    main()
