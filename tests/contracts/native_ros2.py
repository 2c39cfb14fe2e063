"""A plain rclpy node, without any of our code: what the rest of a ROS 2 system looks like to us.

It echoes /native/in to /native/out, latches /native/map and serves /native/add; with an argument it calls
that service with 20 and 22 and prints the sum.
"""

import sys

import rclpy
from jacaros_interfaces.srv import AddTwoInts
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile


def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    response.sum = request.a + request.b
    return response


rclpy.init()
node = rclpy.create_node("native_client" if len(sys.argv) > 1 else "native")
if len(sys.argv) > 1:
    client = node.create_client(AddTwoInts, sys.argv[1])
    assert client.wait_for_service(20)
    future = client.call_async(AddTwoInts.Request(a=20, b=22))
    rclpy.spin_until_future_complete(node, future, timeout_sec=20)
    print(future.result().sum)
else:
    out = node.create_publisher(Odometry, "/native/out", 10)
    node.create_subscription(Odometry, "/native/in", out.publish, 10)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    map_publisher = node.create_publisher(OccupancyGrid, "/native/map", latched)
    map_publisher.publish(OccupancyGrid(data=[0, 100, -1]))
    node.create_service(AddTwoInts, "/native/add", add)
    print("ready", flush=True)
    rclpy.spin(node)
