"""The embedded robot world: TurtleBot-like robots on a plane, reached through ROS topics only."""

from jacaros.sim.data.ground_truth import Event, GroundTruth, Sample
from jacaros.sim.data.world import PersonDescription, WorldDescription, WorldError
from jacaros.sim.files.world import read_world, shipped_worlds
from jacaros.sim.graph.robot_node import RobotNode
from jacaros.sim.node import SimNode
from jacaros.sim.physics.world import World
from jacaros.sim.process import serve

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
