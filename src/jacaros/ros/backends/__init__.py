"""The backends, one file each; only these files import a ROS client library."""
