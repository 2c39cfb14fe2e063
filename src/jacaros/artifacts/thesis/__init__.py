"""Artifacts of the thesis's scenarios: the household, the map of labelled cells, the ROS tutorial."""
