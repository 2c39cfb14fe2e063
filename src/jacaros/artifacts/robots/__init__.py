"""Artifacts for robots: odometry, laser, battery, the connection to ROS, and the motions of wheels.

`velocity` has the motion operations, `motion` one of them from its request to its end, `motion_claim` lets one of them
drive at a time, and `control`, `maneuver`, `journey` compute: pose and goal in, velocity out.
"""
