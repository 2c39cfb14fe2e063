"""ROS 1 through rospy."""
