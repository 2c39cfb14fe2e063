"""Artifacts for robots: the thesis's, made so that each of its known defects is gone.

====================================== ==============================================================
file                                   what it holds
====================================== ==============================================================
`ros_artifact`, `options`, `reading`   what all share: topics, options, policies for sensors
`missing`                              report of a topic that nobody publishes
`odometry`, `laser`, `tutorial`        sensors, and a service
`velocity`, `wheels`                   motion operations
`motion`, `lane`                       one motion from request to end; one motion at a time
`control`, `maneuver`, `journey`       pure control: pose and goal in, velocity out
`battery`, `cleaning`, `map`, `grid`   battery, household, labelled cells and routes over them
====================================== ==============================================================
"""
