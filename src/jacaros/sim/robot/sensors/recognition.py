"""The objects that a robot recognises in its camera image: ``/jason/perception`` (``perception_msgs/msg/perception``).

The original JaCaROS receives this topic from a vision program.
"""

from collections.abc import Iterator

from jacaros.sim.navigation.laser_perception import hidden
from jacaros.sim.robot.on_graph import RobotOnGraph
from jacaros.sim.robot.sensors.rendering import FOCAL_LENGTH, WIDTH

RANGE = 4.0
"""Distance up to which objects are recognised, in metres."""
_TICKS_PER_MESSAGE = 10


class ObjectRecognition:
    """Publishes the objects in view, 2 Hz with subscribers: ``cup,0.30,-0.10,0.00`` is name, metres ahead, left and up."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._world, self._robot = at.time.world, at.robot
        self._publisher = at.publisher("/jason/perception", "perception_msgs/msg/perception", optional=True)

    def publish(self, ticks: int) -> None:
        """Publish if due."""
        publisher = self._publisher
        if ticks % _TICKS_PER_MESSAGE or not publisher.subscription_count:
            return
        publisher.publish(publisher.message(perception=list(self._in_view())))

    def _in_view(self) -> Iterator[str]:
        robot, frame = self._robot, self._robot.placement
        for each in self._world.objects.by_name.values():
            x, y = each.place
            ahead, left = frame.local(x, y)
            in_image = 0.0 < ahead <= RANGE and abs(left) * FOCAL_LENGTH <= 0.5 * WIDTH * ahead
            if in_image and not hidden(self._world.segments, robot.x, robot.y, x, y):
                yield f"{each.name},{ahead:.2f},{left:.2f},0.00"
