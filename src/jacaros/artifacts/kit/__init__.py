"""What artifacts for robots are made of.

================================ ======================================================================
file                             what it holds
================================ ======================================================================
`ros_artifact`                   what all derive from, made of `connected_artifact` (topics, services,
                                 actions) and `sensing_artifact` (readings of sensors)
`options`                        arguments of ``makeArtifact``
`reading`                        policies for sensors
`acting`, `services`             goals, calls, and what an artifact itself offers
`connection`                     is somebody there?
`faults`                         bad messages, and code that fails
================================ ======================================================================
"""
