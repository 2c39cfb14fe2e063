"""A ROS graph inside the process."""
