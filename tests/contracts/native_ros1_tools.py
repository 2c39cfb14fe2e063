"""Programs of ROS 1 itself, as others write them: actionlib, rosparam, tf2_ros.  Of ours they have message classes.

native_ros1_tools.py serve                   a SimpleActionServer at /native/count
    native_ros1_tools.py crowd                   an ActionServer there that treats goals as their targets say
native_ros1_tools.py use NAME TARGET CANCEL  a SimpleActionClient; prints state, text, result and feedback
native_ros1_tools.py cancel NAME             cancels all goals of a server
native_ros1_tools.py rosparam …              the command of that name
native_ros1_tools.py send_tf / look_up_tf    tf2_ros
"""

import json
import sys
import threading
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalID

from jacaros.robots.ros.drivers.ros1.types import GenpySchema

COUNT = "jacaros_interfaces/action/Count"
schema = GenpySchema()


def part(name: str) -> Any:
    return schema.action_class(COUNT, name)


def serve() -> None:
    def count(goal: Any) -> None:
        for number in range(1, goal.target + 1):
            if server.is_preempt_requested():
                server.set_preempted(part("Result")(last=number), "stopped")
                return
            server.publish_feedback(part("Feedback")(current=number))
            rospy.sleep(goal.period)
        if goal.target == 13:
            server.set_aborted(part("Result")(last=13, message="unlucky"), "an unlucky number")
        else:
            server.set_succeeded(part("Result")(last=goal.target))

    server = actionlib.SimpleActionServer("/native/count", part("Action"), count, auto_start=False)
    server.start()
    ready()


def crowd() -> None:
    """Target 1: stays pending until it is cancelled; 2: refused; 3: active, and deaf to cancelling, until 4 comes."""
    kept = []

    def take(handle: Any) -> None:
        target = handle.get_goal().target
        if target == 2:
            handle.set_rejected(None, "not two")
        elif target >= 3:
            handle.set_accepted()
            kept.append(handle)
        if target == 4:
            for each in kept:
                each.set_succeeded(part("Result")(last=each.get_goal().target))

    def cancel(handle: Any) -> None:
        if handle.get_goal().target == 1:
            handle.set_canceled(None, "never begun")

    server = actionlib.ActionServer("/native/count", part("Action"), take, cancel, auto_start=False)
    server.start()
    ready()


def use(name: str, target: str, cancel: str) -> None:
    client = actionlib.SimpleActionClient(name, part("Action"))
    found = client.wait_for_server(rospy.Duration(30))
    feedback: list[int] = []
    enough = threading.Event()

    def hear(message: Any) -> None:
        feedback.append(message.current)
        if len(feedback) == 3:
            enough.set()

    client.send_goal(part("Goal")(target=int(target), period=0.02), feedback_cb=hear)
    if cancel == "cancel":
        enough.wait(30)
        client.cancel_goal()
    elif cancel == "again":  # SimpleActionClient forgets the first
        client.send_goal(part("Goal")(target=1, period=0.02))
    done = client.wait_for_result(rospy.Duration(30))
    result = client.get_result()
    print(
        json.dumps(
            {
                "found": found,
                "done": done,
                "state": actionlib.GoalStatus.to_string(client.get_state()),
                "text": client.get_goal_status_text(),
                "last": result.last if result else None,
                "feedback": feedback[:3],
            }
        )
    )


def cancel_all(name: str) -> None:
    publisher = rospy.Publisher(f"{name}/cancel", GoalID, queue_size=1)
    while not publisher.get_num_connections() and not rospy.is_shutdown():
        rospy.sleep(0.02)
    publisher.publish(GoalID())
    rospy.sleep(0.5)


def other_definition(topic: str) -> None:
    from std_msgs.msg import Int32

    class Newer(Int32):
        _md5sum = "0123456789abcdef0123456789abcdef"

    rospy.Publisher(topic, Newer, queue_size=1)
    ready()


def send_tf() -> None:
    import tf2_ros
    from geometry_msgs.msg import TransformStamped

    def made(parent: str, child: str, x: float) -> Any:
        stamped = TransformStamped(child_frame_id=child)
        stamped.header.frame_id = parent
        stamped.header.stamp = rospy.Time.now()
        stamped.transform.translation.x = x
        stamped.transform.rotation.w = 1.0
        return stamped

    tf2_ros.StaticTransformBroadcaster().sendTransform(made("native_base", "native_laser", 0.5))
    moving = tf2_ros.TransformBroadcaster()
    ready()
    while not rospy.is_shutdown():
        moving.sendTransform(made("native_odom", "native_base", 2.0))
        rospy.sleep(0.05)


def look_up_tf(target: str, source: str) -> None:
    import tf2_ros

    buffer = tf2_ros.Buffer()
    tf2_ros.TransformListener(buffer)
    found = buffer.lookup_transform(target, source, rospy.Time(), rospy.Duration(30))
    print(json.dumps(found.transform.translation.x))


def ready() -> None:
    print("ready", flush=True)


if __name__ == "__main__":
    command, *arguments = sys.argv[1:]
    if command == "rosparam":
        import rosparam

        rosparam.yamlmain(["rosparam", *arguments])
    else:
        rospy.init_node("native", anonymous=True, disable_signals=False)
        {
            "serve": serve,
            "crowd": crowd,
            "use": use,
            "cancel": cancel_all,
            "other_definition": other_definition,
            "send_tf": send_tf,
            "look_up_tf": look_up_tf,
        }[command](*arguments)
        if command in ("serve", "crowd", "other_definition"):
            rospy.spin()
