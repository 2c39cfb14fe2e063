"""What each kind of graph can do in the end, and what its backend does not have yet.

The owner of a backend takes words out of `NOT_YET` as the backend learns; when it is empty it goes, with what reads it.
"""

COMMON = {"topics", "services", "service errors", "transforms", "actions", "parameters"}

CAPABILITIES = {
    "memory": COMMON | {"qos", "declared parameters", "parameter events", "deadlines", "qos in the graph"},
    "ros1": COMMON | {"registration", "parameter events"},
    "ros2": COMMON - {"service errors"}
    | {"qos", "declared parameters", "parameter events", "deadlines", "qos in the graph"},
}
"""Kind of graph → the capabilities (constants of `jacaros.ros.backend`) that its backend has."""

NOT_YET = {
    "memory": set[str](),
    "ros1": set[str](),
    "ros2": set[str](),
}
"""Kind of graph → capabilities, and other words that tests need (marker `needs`), that are still to come."""
