"""The middlewares: everything that the choice with ``--ros`` needs is defined here, once."""

from collections.abc import Mapping
from dataclasses import dataclass

from jacaros.runtime.errors import UsageError


@dataclass(frozen=True, slots=True)
class Middleware:
    """A kind of graph.

    Attributes:
        backend: the class of its nodes, as ``MODULE:NAME``.
        library: Python library that it needs; it is imported only when the kind is chosen.
        install: what to do if the library is missing.
        option: the attribute of `jacaros.robots.ros.open.GraphAddress` that selects one of its graphs.
        keyword: the parameter of the class for this option.
        variable: environment variable that selects the graph if no option does.
        default: the graph without both.
        schemes: schemes of the address, if the option is one.
        example: example of an address.
        unreachable: what to do if the graph cannot be reached.
        deserted: what to do if no other node is in it; default: as `unreachable`.
    """

    backend: str
    library: str = ""
    install: str = ""
    option: str = ""
    keyword: str = ""
    variable: str = ""
    default: str = ""
    schemes: tuple[str, ...] = ()
    example: str = ""
    unreachable: str = ""
    deserted: str = ""

    @property
    def flag(self) -> str:
        """The option as written on a command line."""
        return f"--{self.option.replace('_', '-')}"


_ROS2_CURE = (
    "Is the robot, or `jacaros sim house --ros ros2`, running? It must have the same domain (--domain-id N or "
    "ROS_DOMAIN_ID) and the same ROS_AUTOMATIC_DISCOVERY_RANGE; a long --timeout helps on slow networks"
)

MIDDLEWARES: Mapping[str, Middleware] = {
    "memory": Middleware(
        "jacaros.robots.ros.drivers.memory.backend:BACKEND",
        deserted="Start the robot, or give it a world: --world house",
    ),
    "ros1": Middleware(
        "jacaros.robots.ros.drivers.ros1.backend:BACKEND",
        library="rospy",
        install=(
            "on Debian 12 install python3-rospy and the message packages with apt-get and use a venv made by "
            "`/usr/bin/python3 -m venv --system-site-packages`; tools/install_ros1.sh does both. On a robot with its own "
            "ROS 1, source its setup file first"
        ),
        option="master",
        variable="ROS_MASTER_URI",
        default="http://localhost:11311",
        schemes=("http", "https"),
        example="http://robot.lab.example:11311",
        unreachable=(
            "Start the robot or `roscore`, or say where its master is: --master http://robot.lab.example:11311"
        ),
        deserted="Start the robot, or a world: jacaros sim house --ros ros1",
    ),
    "ros2": Middleware(
        "jacaros.robots.ros.drivers.ros2.backend:BACKEND",
        library="rclpy",
        install=(
            "on Linux x86-64 run `pip install 'jacaros[ros2]'`; tools/install_ros2.sh makes a complete venv. On a robot "
            "with its own ROS 2, source its setup file first"
        ),
        option="domain_id",
        keyword="domain_id",
        variable="ROS_DOMAIN_ID",
        default="0",
        unreachable=_ROS2_CURE,
    ),
    "rosbridge": Middleware(
        "jacaros.robots.ros.drivers.rosbridge.backend:BACKEND",
        library="cbor2",
        install="pip install 'jacaros[rosbridge]'",
        option="bridge",
        keyword="url",
        variable="ROSBRIDGE_URI",
        default="ws://127.0.0.1:9090",
        schemes=("ws", "wss"),
        example="ws://robot.lab.example:9090",
        unreachable="Start rosbridge on the robot, or say where it is: --bridge ws://robot.lab.example:9090",
        deserted=(
            "Start the robot, or a world in the graph of the bridge: jacaros sim house --ros ros1 (or ros2)"
        ),
    ),
}
ROS_KINDS = tuple(MIDDLEWARES)


def middleware(kind: str) -> Middleware:
    """Return the description of a kind of graph.

    Args:
        kind: one of `ROS_KINDS`, or a class of your own as ``MODULE:NAME``, such as ``our_bus:Bus``.

    Raises:
        UsageError: it is neither.
    """
    if kind in MIDDLEWARES:
        return MIDDLEWARES[kind]
    if ":" not in kind:
        raise UsageError(
            f"unknown ROS backend {kind!r}: expected {', '.join(ROS_KINDS)}, or MODULE:NAME for a class of your own"
        )
    return Middleware(kind)
