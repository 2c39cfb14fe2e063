"""The embedded robot world: TurtleBot-like robots on a plane, reached through ROS topics only."""

from jacaros.sim.description import PersonDescription, WorldDescription, WorldError
from jacaros.sim.files.world import read_world, shipped_worlds
from jacaros.sim.graph.robot_node import RobotNode
from jacaros.sim.ground_truth import Event, GroundTruth, Sample
from jacaros.sim.node import SimNode
from jacaros.sim.process import serve
from jacaros.sim.world import World

__all__ = [
    "Event",
    "GroundTruth",
    "PersonDescription",
    "RobotNode",
    "Sample",
    "SimNode",
    "World",
    "WorldDescription",
    "WorldError",
    "read_world",
    "serve",
    "shipped_worlds",
]
