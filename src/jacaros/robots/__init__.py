"""The control layer: ROS, what makes artifacts of it, and the embedded world."""
