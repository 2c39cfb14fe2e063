"""A robot of the world: its state and motion, its ROS interfaces, its sensors and its gripper."""
