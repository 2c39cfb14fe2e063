"""One robot of the world: its state and motion, its place in the ROS graph, its sensors and its gripper."""
