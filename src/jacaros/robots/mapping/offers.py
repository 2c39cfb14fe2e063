"""What a mapping file says about offers of agents: ``offers``, the types of their goals and beliefs in ROS.

offers:
  deliver:
    type: nav2_msgs/action/NavigateToPose
    action: navigate_to_pose
    goal: {x: pose.pose.position.x, y: pose.pose.position.y}
    feedback: {distance_remaining: $progress}
  battery:
    type: sensor_msgs/msg/BatteryState
    fields: {percentage: {value: $level, unit: percent}}
"""

from collections.abc import Iterator
from dataclasses import dataclass

from jacaros.robots.mapping.fields import (
    NOTHING,
    FieldPart,
    FilePosition,
    Written,
    place_of,
    read_field,
    ros_name,
    type_written,
)
from jacaros.robots.mapping.operations import ValuePart, read_values
from jacaros.runtime.files.yaml import YamlNode

FEEDBACK = ("doing", "progress", "note")
"""What is known of a goal before its end."""


@dataclass(frozen=True, slots=True)
class Built:
    """Fields of a message, and the names of the values for them, in the order in which `fill` takes them."""

    names: tuple[str, ...] = ()
    values: tuple[ValuePart, ...] = ()


@dataclass(frozen=True, slots=True)
class OfferPart:
    """One offered goal or belief.

    Attributes:
        type_name: type of the action of a goal, or of the topic of a belief.
        target: name of the action or topic; empty for ``AGENT/NAME``.
        goal: the field of each argument of a goal.
        result, feedback: fields of the result and of feedback of an action.
        fields: fields of the message of a belief.
    """

    name: str
    place: FilePosition
    type_name: Written
    target: Written = NOTHING
    goal: tuple[tuple[str, FieldPart], ...] = ()
    result: Built = Built()
    feedback: Built = Built()
    fields: Built = Built()

    @property
    def is_action(self) -> bool:
        """Whether it is a goal."""
        return "/action/" in self.type_name.text

    def used(self) -> dict[str, set[str]]:
        """Return the arguments that it names, by key."""
        goal = {name for name, _ in self.goal}
        return {"goal": goal, "result": set(self.result.names), "fields": set(self.fields.names)}


OF_ACTION = ("type", "action", "goal", "result", "feedback")
"""Keys of a goal."""
OF_TOPIC = ("type", "topic", "fields")
"""Keys of a belief."""


def read_offers(node: YamlNode) -> dict[str, OfferPart]:
    """Read the offers of a file, by name."""
    found = (_offer(name, value) for name, value in node.entries())
    return {each.name: each for each in found if each is not None}


def _offer(name: YamlNode, node: YamlNode) -> OfferPart | None:
    is_topic = isinstance(node.value, dict) and "/msg/" in str(node.value.get("type", ""))
    entries = node.mapping(*(OF_TOPIC if is_topic else OF_ACTION), required=("type",))
    if "type" not in entries:
        return None
    type_name = type_written(entries["type"], "msg" if is_topic else "action")
    if type_name is None:
        return None
    target = entries.get("topic", entries.get("action"))
    part = OfferPart(
        str(name.value),
        place_of(name),
        type_name,
        ros_name(target) if target is not None else NOTHING,
        tuple((str(key.value), read_field(value)) for key, value in entries["goal"].entries())
        if "goal" in entries
        else (),
        *(_built(entries.get(key)) for key in ("result", "feedback", "fields")),
    )
    for each in set(part.feedback.names) - set(FEEDBACK):
        entries["feedback"].wrong(f"feedback has no `${each}`", f"write ${', $'.join(FEEDBACK)}")
    return part


def _built(node: YamlNode | None) -> Built:
    if node is None:
        return Built()
    names = tuple(dict.fromkeys(_names(node.value)))
    return Built(names, read_values(node, names))


def _names(value: object) -> Iterator[str]:
    """Yield the names behind ``$`` in the values of fields."""
    if isinstance(value, dict):
        for each in value.values():
            yield from _names(each)
    elif isinstance(value, str) and value.startswith("$"):
        yield value[1:]
