"""Building blocks of artifacts for robots.

=================== ===================================================================================
file                content
=================== ===================================================================================
`ros_artifact`      the parent class: topics, services, actions and sensor readings, closed on disposal
`options`           arguments of ``makeArtifact``
`reading`           reading policies for sensors; the range of view
`acting`            action goals
`services`          service calls, and services that an artifact offers
`connection`        publishers and subscribers at the other end
`faults`            bad messages, and failing callbacks
=================== ===================================================================================
"""
