"""Artifacts for robots: the thesis's, made so that each of its known defects is gone; and what one's own are made of.

======================================== ==============================================================
file                                     what it holds
======================================== ==============================================================
`ros_artifact`                           what all derive from, made of `connected_artifact` (topics, services, actions)
                                         and `sensing_artifact` (readings of sensors)
`options`                                arguments of ``makeArtifact``
`reading`, `view`                        policies for sensors
`acting`, `calling`, `offering`          goals, calls, and what an artifact itself offers
`connection`, `missing`                  is somebody there?
`faults`, `listener`                     bad messages, and code that fails
`odometry`, `laser`, `tutorial`          sensors, and a service
`velocity`, `wheels`                     motion operations
`motion`, `lane`                         one motion from request to end; one motion at a time
`control`, `maneuver`, `journey`         pure control: pose and goal in, velocity out
`battery`, `cleaning`, `map`, `grid`     battery, household, labelled cells and routes over them
======================================== ==============================================================
"""
