"""What each kind of graph can do, and what cannot be shown on it."""

from bridges import BRIDGED

COMMON = {"topics", "services", "service errors", "transforms", "actions", "parameters"}

CAPABILITIES = {
    "memory": COMMON | {"qos", "declared parameters", "parameter events", "deadlines", "qos in the graph"},
    "ros1": COMMON | {"discovery", "registration", "parameter events"},
    "ros2": COMMON - {"service errors"}
    | {"discovery", "qos", "declared parameters", "parameter events", "deadlines", "qos in the graph"},
    **{
        kind: (COMMON - {"service errors"})
        | {"discovery"}
        | ({"parameter events"} if "ros2" in kind else set())
        for kind in BRIDGED
    },
}
# There the peer that is asked is a node of the graph itself.
CAPABILITIES["mqtt"] = {"topics", "transforms", "discovery"}
CAPABILITIES["rosbridge-ros2-right"] = CAPABILITIES["memory"]
"""Kind of graph → the capabilities (`jacaros.robots.ros.node.Capability`) that its backend has."""

_SERVED_OVER_A_BRIDGE = {"refusing goals", "dying servers", "parameters"}
BEYOND = {
    # A goal is accepted by the bridge, which aborts it when its server goes; it has parameters for nodes alone.
    "rosbridge-ros2": _SERVED_OVER_A_BRIDGE | {"events"},
    "rosbridge-ros2-right": _SERVED_OVER_A_BRIDGE | {"events", "failing services"},
    "rosbridge-ros2-left": {"events", "own parameters", "given parameters", "dying servers"},
    "rosbridge-ros1": {"events", "given parameters"},
    "mqtt": {"services", "actions", "parameters", "deadlines", "rosout"},
    # The graph behind the bridge is one of ROS 2 without actionlib and without a master.
    "rosbridge-ros1-left": {"events", "actions", "parameters", "contents", "failing services", "rosout"},
}
"""Kind of graph → what cannot be shown on it, though its backend has the capability."""
