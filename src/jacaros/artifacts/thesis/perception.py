"""``ArtPerception``: percepts that another program sends as texts."""

import math
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.kit.options import text, yes_or_no
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.ros.node import Sample


class ArtPerception(RosArtifact):
    """Shows the texts of ``/jason/perception`` (``perception_msgs/msg/perception``, a list of texts).

    Each message replaces the percepts of the previous one; an unchanged text causes no event.

    Options:
        topic(T): another topic.
        split(true): show the parts between commas, with numbers as numbers.

    Properties:
        perception(Text): one for each text of the newest message, such as ``"box1,1.0,2.0,3.1"``; with `split`
            ``perception("box1", 1.0, 2.0, 3.1)``.

    Signals:
        tick_perception: `getPerception` was called.
    """

    known_options: ClassVar = {"topic": text, "split": yes_or_no}

    def open(self) -> None:
        """Subscribe; there are no percepts before the first message."""
        self._texts: list[str] = []
        self.subscription(
            str(self.options.get("topic", "jason/perception")), "perception_msgs/msg/perception", self._take
        )

    def _take(self, sample: Sample) -> None:
        self._texts = [str(each) for each in sample.message.perception]
        split = self.options.get("split", False)
        elements = [tuple(map(_value, each.split(","))) if split else (each,) for each in self._texts]
        self.start(self.show_elements, "perception", elements, cause=sample.cause)

    @operation(name="getPerception")
    def get_perception(self) -> None:
        """Signal ``tick_perception``; the properties are always current."""
        self.signal("tick_perception")

    @operation(name="getPerception")
    def give_perception(self, texts: Out) -> None:
        """Give the texts of the newest message to the caller, as a list; empty before the first."""
        texts.set(self._texts)


def _value(part: str) -> str | float:
    """Return a number if the text is a finite one."""
    try:
        number = float(part)
    except ValueError:
        return part.strip()
    return number if math.isfinite(number) else part.strip()
