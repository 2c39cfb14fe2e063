"""Artifacts of the thesis's scenarios: the household, the ROS tutorial."""
