"""The map of the building. Each robot has one."""

from jacaros.artifacts import Artifact, Atom, operation


class Map(Artifact):
    """What one robot knows of the rooms, for itself and for all that observe it.

    Properties:
        here(Robot): this robot is at work.
        taken(Room, Robot): the room that this robot is cleaning. It vanishes with the robot's process.
        clean(Room, Robot): a room that a robot has cleaned. All maps get it.
    """

    @operation
    def enter(self) -> None:
        """Begin to work."""
        self.define_property("here", self.caller)

    @operation
    def take(self, room: Atom) -> None:
        """Begin to clean a room."""
        self.define_property("taken", room, self.caller)

    @operation
    def leave(self, room: Atom) -> None:
        """Stop cleaning a room."""
        self.remove_property("taken", room, self.caller)

    @operation
    def note(self, room: Atom, robot: Atom) -> None:
        """Note that a room is clean."""
        if not self.has_property("clean", room, robot):
            self.define_property("clean", room, robot)
