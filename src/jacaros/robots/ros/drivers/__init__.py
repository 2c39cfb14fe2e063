"""Middlewares: each folder joins one kind of ROS graph, and is imported on demand only."""
