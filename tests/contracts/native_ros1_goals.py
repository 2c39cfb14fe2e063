"""A plain actionlib client (of ours it has message classes): gives a goal to an agent, and prints what it hears.

    python native_ros1_goals.py ACTION GOAL [--cancel]

The lines and the numbers of states are those of ``native_ros2_goals.py``.
"""

import json
import sys
import threading

import actionlib
import rospy

from jacaros.robots.ros.drivers.ros1.types import GenpySchema

STATUS = {"SUCCEEDED": 4, "PREEMPTED": 5, "ABORTED": 6}
name, goal = sys.argv[1:3]
schema = GenpySchema()
action, goal_class = (
    schema.action_class("jacaros_interfaces/action/Achieve", part) for part in ("Action", "Goal")
)
rospy.init_node("native_goals")
client = actionlib.SimpleActionClient(name, action)
assert client.wait_for_server(rospy.Duration(30)), "no action server"
heard = threading.Event()


def say(**what: object) -> None:
    print(json.dumps(what), flush=True)


def hear(told) -> None:
    say(doing=told.doing, progress=told.progress, note=told.note)
    heard.set()


client.send_goal(goal_class(goal=goal), feedback_cb=hear)
say(accepted=True)
if "--cancel" in sys.argv:
    assert heard.wait(60)
    client.cancel_goal()
    say(cancelling=1)
assert client.wait_for_result(rospy.Duration(60)), "no result"
told = client.get_result()
status = STATUS[actionlib.GoalStatus.to_string(client.get_state())]
say(status=status, state=told.state, results=told.results, message=told.message, reasons=list(told.reasons))
