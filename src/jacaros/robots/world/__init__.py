"""The embedded robot world: TurtleBot-like robots on a plane, reached through ROS topics only."""

from jacaros.robots.world.data.ground_truth import GroundTruth, PathSample, RobotEvent
from jacaros.robots.world.data.world import PersonDescription, WorldDescription, WorldError
from jacaros.robots.world.files.world import read_world, shipped_worlds
from jacaros.robots.world.graph.robot_node import RobotNode
from jacaros.robots.world.node import SimNode
from jacaros.robots.world.physics.world import World
from jacaros.robots.world.process import serve

__all__ = [
    "GroundTruth",
    "PathSample",
    "PersonDescription",
    "RobotEvent",
    "RobotNode",
    "SimNode",
    "World",
    "WorldDescription",
    "WorldError",
    "read_world",
    "serve",
    "shipped_worlds",
]
