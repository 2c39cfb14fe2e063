"""A plain rospy node (of ours it has the service class alone): what the rest of a ROS 1 system is to us.

It echoes /native/in to /native/out, latches /native/map and serves /native/add; with an argument it calls
that service with 20 and 22 and prints the sum.
"""

import sys

import rospy
from nav_msgs.msg import OccupancyGrid, Odometry


def add_class() -> type:
    from jacaros.robots.ros.drivers.ros1.types import GenpySchema

    found: type = GenpySchema().service_class("example_interfaces/srv/AddTwoInts")
    return found


rospy.init_node("native", anonymous=len(sys.argv) > 1)
if len(sys.argv) > 1:
    rospy.wait_for_service(sys.argv[1], 20)
    print(rospy.ServiceProxy(sys.argv[1], add_class())(20, 22).sum)
else:
    out = rospy.Publisher("/native/out", Odometry, queue_size=10)
    rospy.Subscriber("/native/in", Odometry, out.publish)
    rospy.Publisher("/native/map", OccupancyGrid, queue_size=1, latch=True).publish(
        OccupancyGrid(data=[0, 100, -1])
    )
    rospy.Service("/native/add", add_class(), lambda request: request.a + request.b)
    print("ready", flush=True)
    rospy.spin()
