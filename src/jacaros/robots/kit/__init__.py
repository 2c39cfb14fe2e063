"""Building blocks of artifacts for robots.

=================== ===================================================================================
file                content
=================== ===================================================================================
`ros_artifact`      the parent class: topics, services, actions and sensor readings, closed on disposal
`options`           arguments of ``makeArtifact``
`reading`           messages of sensors: bad ones, reading policies, the range of view
`acting`            action goals
`services`          service calls, and services that an artifact offers
`connection`        publishers and subscribers at the other end
=================== ===================================================================================
"""
