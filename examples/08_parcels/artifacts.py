"""The post: parcels that wait in rooms, and parcels on the robot."""

from jacaros.artifacts import Atom, operation
from jacaros.robots.kit.ros_artifact import RosArtifact


class Post(RosArtifact):
    """Parcel delivery between the rooms of a house.

    Loading and unloading are also published as text, such as ``load 2``, on ``/cleaning/task``: the embedded world
    logs them with the room that the robot is actually in.

    Properties:
        parcel(Number, From, To): a parcel that waits in room From, for room To.
        aboard(Number, To): a parcel on the robot, for room To.
        delivered(Count): number of parcels delivered.
    """

    def open(self) -> None:
        """Start without parcels."""
        self.last = 0
        self.define_property("delivered", 0)
        self.journal = self.publisher("cleaning/task", "std_msgs/msg/String")

    @operation
    def order(self, start: Atom, goal: Atom) -> None:
        """Add a parcel that waits in room *start*, for room *goal*."""
        self.last += 1
        self.define_property("parcel", self.last, start, goal)

    @operation
    def load(self, number: int) -> None:
        """Load a waiting parcel; fails with ``no_parcel(Number)`` if it does not wait anywhere."""
        if not self.has_property("parcel", number, None, None):
            self.fail(f"parcel {number} does not wait anywhere", "no_parcel", number)
        (parcel,) = self.find_properties("parcel", number, None, None)
        self.remove_property("parcel", number, None, None)
        self.define_property("aboard", number, parcel.values[2])
        self.journal.publish(self.journal.message(data=f"load {number}"))

    @operation
    def unload(self, number: int) -> None:
        """Deliver a parcel; fails with ``no_parcel(Number)`` if it is not on the robot."""
        if not self.has_property("aboard", number, None):
            self.fail(f"parcel {number} is not on the robot", "no_parcel", number)
        self.remove_property("aboard", number, None)
        self.update_property("delivered", self.value("delivered") + 1)
        self.journal.publish(self.journal.message(data=f"unload {number}"))
