"""Middlewares: each folder joins one kind of ROS graph, and is imported only when that is asked for."""
