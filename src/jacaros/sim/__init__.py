"""The embedded robot world: TurtleBot-like robots on a plane, reached over ROS topics only."""

from jacaros.sim.description import WorldDescription
from jacaros.sim.errors import WorldError
from jacaros.sim.ground_truth import GroundTruth
from jacaros.sim.world import World
from jacaros.sim.world_file import read_world, shipped_worlds

__all__ = ["GroundTruth", "World", "WorldDescription", "WorldError", "read_world", "shipped_worlds"]
