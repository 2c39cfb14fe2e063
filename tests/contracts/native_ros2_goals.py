"""A plain rclpy action client, without any of our code: gives a goal to an agent, and prints what it hears as JSON lines.

    python native_ros2_goals.py ACTION GOAL [--cancel]

With --cancel it cancels the goal after its first feedback.
"""

import json
import sys

import rclpy
from jacaros_interfaces.action import Achieve
from rclpy.action import ActionClient

name, goal = sys.argv[1:3]
cancelling = "--cancel" in sys.argv
rclpy.init()
node = rclpy.create_node("native_goals")
client = ActionClient(node, Achieve, name)
assert client.wait_for_server(30), "no action server"


def say(**what: object) -> None:
    print(json.dumps(what), flush=True)


feedback = rclpy.task.Future()


def heard(message) -> None:
    told = message.feedback
    say(doing=told.doing, progress=told.progress, note=told.note)
    if not feedback.done():
        feedback.set_result(None)


def until(future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=60)
    assert future.done(), "no answer"
    return future.result()


handle = until(client.send_goal_async(Achieve.Goal(goal=goal), heard))
say(accepted=handle.accepted)
if handle.accepted:
    if cancelling:
        until(feedback)
        say(cancelling=len(until(handle.cancel_goal_async()).goals_canceling))
    end = until(handle.get_result_async())
    told = end.result
    say(
        status=end.status,
        state=told.state,
        results=told.results,
        message=told.message,
        reasons=list(told.reasons),
    )
