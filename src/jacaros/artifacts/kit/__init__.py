"""Building blocks of artifacts for robots.

================================ ======================================================================
file                             content
================================ ======================================================================
`ros_artifact`                   the parent class, built from `connected_artifact` (topics, services,
                                 actions) and `sensing_artifact` (sensor readings)
`options`                        arguments of ``makeArtifact``
`reading`                        reading policies for sensors
`acting`, `services`             action goals, service calls, and services that an artifact offers
`connection`                     whether a publisher or subscriber is connected
`faults`                         bad messages, and failing callbacks
================================ ======================================================================
"""
