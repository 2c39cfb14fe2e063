"""The world on a ROS graph: everything that publishes, subscribes and serves."""
