"""``ArtBumper`` and ``ArtCliff``: the bumper and cliff events of a Kobuki base (TurtleBot 2)."""

from typing import ClassVar

from jacaros.artifacts.env.artifact import internal_operation, operation
from jacaros.artifacts.env.values import Atom
from jacaros.artifacts.kit.options import text
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.ros.node import Sample

SIDES: tuple[str, ...] = ("left", "center", "right")
"""Sides by their numbers in ``kobuki_msgs/msg/BumperEvent`` and ``CliffEvent``."""


class KobukiEvents(RosArtifact):
    """Three sensors that publish an event when they change; state 1 is signalled."""

    known_options: ClassVar = {"topic": text}
    event_topic: ClassVar[str]
    event_type: ClassVar[str]
    side_field: ClassVar[str]
    property_name: ClassVar[str]
    states: ClassVar[tuple[str, str]]

    def open(self) -> None:
        """Define the property of each side and subscribe."""
        self._shown = dict.fromkeys(SIDES, self.states[0])
        for side in SIDES:
            self.define_property(self.property_name, Atom(side), Atom(self.states[0]))
        topic = str(self.options.get("topic", self.event_topic))
        self._faults = self.faults_of(topic)
        self.subscription(topic, self.event_type, self._take)

    def _take(self, sample: Sample) -> None:
        side, state = int(getattr(sample.message, self.side_field)), int(sample.message.state)
        if side >= len(SIDES):
            self._faults.out_of_range(self.side_field, side)
        elif state >= len(self.states):
            self._faults.out_of_range("state", state)
        else:
            self.start(self.show_event, SIDES[side], self.states[state], cause=sample.cause)

    @internal_operation
    def show_event(self, side: str, state: str) -> None:
        """Show the new state of a side, and signal state 1."""
        if self._shown[side] != state:
            self.remove_property(self.property_name, Atom(side), Atom(self._shown[side]))
            self.define_property(self.property_name, Atom(side), Atom(state))
            self._shown[side] = state
        if state == self.states[1]:
            self.signal(f"tick_{self.property_name.capitalize()}_{side.upper()}")


class ArtBumper(KobukiEvents):
    """Shows the bumpers of a Kobuki from ``/mobile_base/events/bumper`` (``kobuki_msgs/msg/BumperEvent``).

    Options:
        topic(T): another topic.

    Properties:
        bumper(Side, State): one for each side, ``left``, ``center`` and ``right``; the state is ``released`` or
            ``pressed``.

    Signals:
        tick_Bumper_LEFT, tick_Bumper_CENTER, tick_Bumper_RIGHT: that bumper was pressed.
        tick_Bumper: `getCurrentBumper` was called.
    """

    event_topic = "mobile_base/events/bumper"
    event_type = "kobuki_msgs/msg/BumperEvent"
    side_field = "bumper"
    property_name = "bumper"
    states = ("released", "pressed")

    @operation(name="getCurrentBumper")
    def get_current_bumper(self) -> None:
        """Signal ``tick_Bumper``; the properties are always current."""
        self.signal("tick_Bumper")


class ArtCliff(KobukiEvents):
    """Shows the cliff sensors of a Kobuki from ``/mobile_base/events/cliff`` (``kobuki_msgs/msg/CliffEvent``).

    Options:
        topic(T): another topic.

    Properties:
        cliff(Side, State): one for each side, ``left``, ``center`` and ``right``; the state is ``floor`` or
            ``cliff``.

    Signals:
        tick_Cliff_LEFT, tick_Cliff_CENTER, tick_Cliff_RIGHT: that sensor no longer detects the floor.
        tick_Cliff: `getCurrentCliff` was called.
    """

    event_topic = "mobile_base/events/cliff"
    event_type = "kobuki_msgs/msg/CliffEvent"
    side_field = "sensor"
    property_name = "cliff"
    states = ("floor", "cliff")

    @operation(name="getCurrentCliff")
    def get_current_cliff(self) -> None:
        """Signal ``tick_Cliff``; the properties are always current."""
        self.signal("tick_Cliff")
