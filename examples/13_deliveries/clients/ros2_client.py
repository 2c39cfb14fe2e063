"""Ask for a delivery over ROS 2, as any node does: ``python3 ros2_client.py mail kitchen``."""

import json
import sys

import rclpy
from jacaros_interfaces.action import Achieve
from rclpy.action import ActionClient


def main() -> int:
    """Send the goal, print the feedback and the result."""
    parcel, room = sys.argv[1:]
    rclpy.init()
    node = rclpy.create_node("orders")
    client = ActionClient(node, Achieve, "/robot/deliver")
    client.wait_for_server()
    goal = Achieve.Goal(goal=json.dumps({"parcel": parcel, "room": room}))
    sent = client.send_goal_async(goal, lambda message: print(message.feedback.doing, message.feedback.note))
    rclpy.spin_until_future_complete(node, sent)
    ended = sent.result().get_result_async()
    rclpy.spin_until_future_complete(node, ended)
    result = ended.result().result
    print(result.state, result.results if result.state == "achieved" else result.message)
    return 0 if result.state == "achieved" else 1


if __name__ == "__main__":
    sys.exit(main())
