"""The post: which parcels wait where, and which are on the robot."""

from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env import Atom, operation


class Post(RosArtifact):
    """Parcels between the rooms of a house.

    What is loaded and unloaded is also published as text, such as ``load 2``, on ``/cleaning/task``: the embedded
    world logs it with the room in which the robot truly is.

    Properties:
        parcel(Number, From, To): a parcel waits in the room From.
        aboard(Number, To): a parcel is on the robot.
        delivered(Count): so many have reached their rooms.
    """

    def open(self) -> None:
        """Begin without parcels."""
        self.last = 0
        self.define_property("delivered", 0)
        self.journal = self.publisher("cleaning/task", "std_msgs/msg/String")

    @operation
    def order(self, start: Atom, goal: Atom) -> None:
        """Let a parcel wait in a room."""
        self.last += 1
        self.define_property("parcel", self.last, start, goal)

    @operation
    def load(self, number: int) -> None:
        """Put a parcel that waits on the robot."""
        if not self.has_property("parcel", number, None, None):
            self.fail(f"parcel {number} does not wait anywhere", "no_parcel", number)
        (parcel,) = self.find_properties("parcel", number, None, None)
        self.remove_property("parcel", number, None, None)
        self.define_property("aboard", number, parcel.values[2])
        self.journal.publish(self.journal.message(data=f"load {number}"))

    @operation
    def unload(self, number: int) -> None:
        """Take a parcel from the robot: it has been delivered."""
        if not self.has_property("aboard", number, None):
            self.fail(f"parcel {number} is not on the robot", "no_parcel", number)
        self.remove_property("aboard", number, None)
        self.update_property("delivered", self.value("delivered") + 1)
        self.journal.publish(self.journal.message(data=f"unload {number}"))
