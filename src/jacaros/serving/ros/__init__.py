"""The ROS door: what agents offer, as actions, topics and services of the run's node."""
