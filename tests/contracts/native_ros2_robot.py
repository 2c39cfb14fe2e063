"""Plain rclpy nodes with actions and parameters, without any of our code.

python native_ros2_robot.py serve        serves /native/count, and parameters, on several threads
python native_ros2_robot.py block        the same with one thread, which is blocked while it counts, without feedback
python native_ros2_robot.py forget       a node whose first response about its parameters is lost
python native_ros2_robot.py goal NAME    sends two goals there and cancels the second; prints what it learns
python native_ros2_robot.py ask NODE     reads and writes parameters of a node; prints what it learns
"""

import sys
import time
from typing import Any

import rclpy
from jacaros_interfaces.action import Count
from rcl_interfaces.msg import (
    FloatingPointRange,
    Parameter,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
)
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor


def count(goal: Any, with_feedback: bool) -> Any:
    done = 0
    while done < goal.request.target:
        if goal.is_cancel_requested:
            goal.canceled()
            return Count.Result(last=done, message="as you wish")
        done += 1
        if with_feedback:
            goal.publish_feedback(Count.Feedback(current=done))
        time.sleep(goal.request.period)
    goal.succeed()
    return Count.Result(last=done, message="counted natively")


def serve(node: Any, blocking: bool) -> None:
    node.declare_parameter(
        "speed",
        0.5,
        ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)]),
    )
    node.declare_parameter("rooms", ["kitchen", "hall"])
    ActionServer(
        node,
        Count,
        "/native/count",
        lambda goal: count(goal, not blocking),
        goal_callback=lambda goal: GoalResponse.REJECT if goal.target < 0 else GoalResponse.ACCEPT,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
        callback_group=None if blocking else ReentrantCallbackGroup(),
    )
    executor = SingleThreadedExecutor() if blocking else MultiThreadedExecutor(4)
    executor.add_node(node)
    print("ready", flush=True)
    executor.spin()


def forget(node: Any) -> None:
    def answer(_: Any, response: Any) -> Any:
        response.result.names = ["speed"]
        return response

    service = node.create_service(ListParameters, f"/{node.get_name()}/list_parameters", answer)
    send, lost = service.send_response, []

    def send_but_the_first(response: Any, header: Any) -> None:
        if lost:
            send(response, header)
        lost.append(response)

    service.send_response = send_but_the_first
    print("ready", flush=True)
    rclpy.spin(node)


def wait(node: Any, future: Any) -> Any:
    rclpy.spin_until_future_complete(node, future, timeout_sec=20)
    return future.result()


def send_goals(node: Any, name: str) -> None:
    client = ActionClient(node, Count, name)
    assert client.wait_for_server(20)
    feedback: list[int] = []
    goal = wait(
        node,
        client.send_goal_async(
            Count.Goal(target=3, period=0.05), lambda told: feedback.append(told.feedback.current)
        ),
    )
    answer = wait(node, goal.get_result_async())
    print("counted", answer.status, answer.result.last, feedback[-1], flush=True)
    goal = wait(node, client.send_goal_async(Count.Goal(target=1000, period=0.05)))
    cancelled = wait(node, goal.cancel_goal_async())
    answer = wait(node, goal.get_result_async())
    print("cancelled", cancelled.return_code, len(cancelled.goals_canceling), answer.status, flush=True)
    goal = wait(node, client.send_goal_async(Count.Goal(target=-1)))
    print("accepted", goal.accepted, flush=True)


def ask(node: Any, other: str) -> None:
    def call(kind: Any, service: str, request: Any) -> Any:
        client = node.create_client(kind, f"{other}/{service}")
        assert client.wait_for_service(20)
        for _ in range(8):  # a server that discovers us late loses its response
            future = client.call_async(request)
            rclpy.spin_until_future_complete(node, future, timeout_sec=3)
            if future.done():
                return future.result()
        raise AssertionError(f"{service} gave no response")

    def put(value: int) -> Any:
        told = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=value)
        request = SetParameters.Request(parameters=[Parameter(name="lanes", value=told)])
        return call(SetParameters, "set_parameters", request).results[0]

    names = call(ListParameters, "list_parameters", ListParameters.Request()).result.names
    print("names", "lanes" in names, "use_sim_time" in names, flush=True)
    print("put", put(6).successful, put(70).successful, flush=True)
    values = call(GetParameters, "get_parameters", GetParameters.Request(names=["lanes"])).values
    print("got", values[0].integer_value, flush=True)


rclpy.init()
made = rclpy.create_node(f"native_{sys.argv[1]}", start_parameter_services=sys.argv[1] != "forget")
if sys.argv[1] in ("serve", "block"):
    serve(made, sys.argv[1] == "block")
elif sys.argv[1] == "forget":
    forget(made)
elif sys.argv[1] == "goal":
    send_goals(made, sys.argv[2])
else:
    ask(made, sys.argv[2])
