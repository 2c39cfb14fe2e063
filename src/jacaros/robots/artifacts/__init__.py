"""Artifacts for robots: odometry, laser, battery, the connection to ROS, and motions of wheels.

`velocity` has the motion operations, `driving` lets one drive at a time, `motion` runs it. `maneuver`,
`approach` and `drive_model` are pure computation: pose and goal in, velocity out.
"""
