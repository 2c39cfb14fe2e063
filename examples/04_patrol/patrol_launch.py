"""Start the world and the agents of the patrol on ROS 2: ``ros2 launch examples/04_patrol/patrol_launch.py``."""

from pathlib import Path

from launch import LaunchDescription
from launch_ros.actions import Node

FOLDER = Path(__file__).parent


def generate_launch_description() -> LaunchDescription:
    """Return the world, in place of a robot, and the agents, which follow its clock."""
    world = Node(
        package="jacaros",
        executable="jacaros",
        name="world",
        arguments=["sim", str(FOLDER / "patrol.yaml"), "--publish-clock"],
    )
    agents = Node(
        package="jacaros",
        executable="jacaros",
        name="patrol",
        output="screen",
        arguments=["run", str(FOLDER / "patrol.jcm")],
        parameters=[{"use_sim_time": True}],
    )
    return LaunchDescription([world, agents])
