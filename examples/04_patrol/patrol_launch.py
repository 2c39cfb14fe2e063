"""Start the world and the agents of the patrol on ROS 2: ``ros2 launch examples/04_patrol/patrol_launch.py``.

With ``lifecycle:=true``, the agents wait until their node is configured and activated.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode, Node

FOLDER = Path(__file__).parent


def generate_launch_description() -> LaunchDescription:
    """Return the world, in place of a robot, and the agents, which follow its clock."""
    world = Node(
        package="jacaros",
        executable="jacaros",
        name="world",
        arguments=["sim", str(FOLDER / "patrol.yaml"), "--publish-clock"],
    )
    run = ["run", str(FOLDER / "patrol.jcm")]
    agents = Node(
        package="jacaros",
        executable="jacaros",
        name="patrol",
        output="screen",
        arguments=run,
        parameters=[{"use_sim_time": True}],
        condition=UnlessCondition(LaunchConfiguration("lifecycle")),
    )
    managed = LifecycleNode(
        package="jacaros",
        executable="jacaros",
        name="patrol",
        namespace="",
        output="screen",
        arguments=[*run, "--lifecycle"],
        parameters=[{"use_sim_time": True}],
        condition=IfCondition(LaunchConfiguration("lifecycle")),
    )
    lifecycle = DeclareLaunchArgument("lifecycle", default_value="false")
    return LaunchDescription([lifecycle, world, agents, managed])
