"""JSON Schemas of world, fault and mapping files, from the declarations that their readers use.

Editors complete keys and mark mistakes with them. They are laxer than the readers, which also know places, names and types.
"""

from collections.abc import Iterable, Mapping
from typing import Any

from jacaros.robots.mapping import fields, offers, operations, properties
from jacaros.robots.mapping.file import ArtifactPart
from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.shapes import Segment
from jacaros.robots.streams import OPERATORS
from jacaros.robots.world.data import robot, world
from jacaros.robots.world.data.faults import KINDS, Fault
from jacaros.robots.world.files.robot import SECTIONS
from jacaros.robots.world.files.world import KEYS as WORLD_KEYS
from jacaros.runtime.files.entries import declared_entries

Schema = dict[str, Any]
NUMBER: Schema = {"type": "number"}
TEXT: Schema = {"type": "string"}
SWITCH: Schema = {"type": "boolean"}
PAIR: Schema = {"type": "array", "items": NUMBER, "minItems": 2, "maxItems": 2}
POINTS: Schema = {"type": "array", "items": PAIR}
ANYTHING: Schema = {}


def mapping(properties: Mapping[str, Schema], required: Iterable[str] = ()) -> Schema:
    """Return the schema of a mapping with these keys and no others."""
    needed = list(required)
    return {
        "type": "object",
        "properties": dict(properties),
        "additionalProperties": False,
        **({"required": needed} if needed else {}),
    }


def named(item: Schema) -> Schema:
    """Return the schema of a mapping from names to items."""
    return {"type": "object", "additionalProperties": item}


def listed(item: Schema) -> Schema:
    """Return the schema of a list."""
    return {"type": "array", "items": item}


def declared(usual: Any, **others: Schema) -> Schema:
    """Return the schema of a mapping whose keys are declared at the fields of a dataclass.

    Args:
        usual: an instance with the defaults.
        others: further keys, and those whose declarations have no schema.
    """
    found: dict[str, Schema] = {}
    required = []
    for key, (name, entry, needed) in declared_entries(usual).items():
        default = getattr(usual, name)
        inner = declared(default) if entry.schema == {"type": "object"} else dict(entry.schema)
        words = f"{entry.words}: {entry.help}" if entry.help else entry.words
        found[key] = {**inner, **others.pop(key, {}), **({"description": words} if words else {})}
        if needed:
            required.append(key)
    return mapping({**found, **others}, required)


RECTANGLE = mapping({"from": PAIR, "to": PAIR})
POSE = mapping({"x": NUMBER, "y": NUMBER, "yaw_degrees": NUMBER})


def worlds() -> Schema:
    """Return the schema of world files."""
    of_robots = {
        "kind": TEXT,
        "pose": POSE,
        "navigation": {"anyOf": [SWITCH, declared(robot.NavigationSettings())]},
        "gripper": {"anyOf": [SWITCH, mapping({"reach": NUMBER})]},
        "tools": named(declared(robot.CleaningTool("", ()), removes=listed(TEXT))),
        **dict.fromkeys(SECTIONS, named(ANYTHING)),
    }
    dock = declared(world.Dock("", Pose(0.0, 0.0, 0.0)), x=NUMBER, y=NUMBER, yaw_degrees=NUMBER)
    box = {"anyOf": [RECTANGLE, {"type": "object"}]}
    wall = {"segment": POINTS, "polyline": POINTS, "box": box, "closed": SWITCH}
    own = {
        "map": TEXT,
        "size": PAIR,
        "bounds": RECTANGLE,
        "border": {"enum": ["open", "walls"]},
        "walls": listed(mapping(wall)),
        "rooms": named(ANYTHING),
        "docks": listed({**dock, "required": ["x", "y"]}),
        "doors": listed(declared(world.Door("", Segment(0.0, 0.0, 1.0, 0.0)), segment=POINTS)),
        "cliffs": listed(RECTANGLE),
        "objects": listed(declared(world.ObjectDescription("", 0.0, 0.0))),
        "robots": {**listed(declared(robot.RobotDescription(), **of_robots)), "minItems": 1},
        "people": listed(declared(world.PersonDescription("", ()), path=POINTS)),
    }
    found = declared(world.WorldDescription(), **own)
    found["properties"] = {key: found["properties"][key] for key in WORLD_KEYS}
    return {**found, "required": ["robots"]}


def faults() -> Schema:
    """Return the schema of fault files."""
    place = {**POSE, "required": ["x", "y"]}
    own = {
        "to": {"anyOf": [NUMBER, place]},
        **declared(world.PersonDescription("", ()), path=POINTS)["properties"],
    }
    one = {"minProperties": 1, "maxProperties": 1}
    keys = {**own, **declared(Fault("", ""), after=one)["properties"]}
    kinds = []
    for name, kind in KINDS.items():
        others = {key: keys[key] for key in ("at", "after", "for", *kind.keys)}
        kinds.append(mapping({"kind": {"const": name}, "robot": TEXT, **others}, ["kind"]))
    return mapping({"faults": named({"anyOf": kinds})}, ["faults"])


POLICIES: Schema = mapping(
    {
        **{key: {"enum": list(words)} for key, words in properties.CHOICES.items()},
        "depth": {"type": "integer", "minimum": 1, "description": "messages that are kept"},
        "deadline": {"type": "number", "description": "seconds"},
    }
)
QOS: Schema = {"anyOf": [{"enum": list(properties.PROFILES)}, POLICIES]}
MEANINGS: Mapping[str, str] = {
    "action": "name of the action",
    "as": "the agent's form of the value: an angle of a quaternion, a constant's name, an atom, or a number about a list",
    "dead_band": "changes up to this size are ignored; a number, or a list with one per value",
    "default": "default value, which also sets the type",
    "description": "text for `jacaros describe` and editors",
    "duration": "seconds during which a message is repeated",
    "each": "an array of the message: one property for each element",
    "expect": "observations that must follow, else the operation fails",
    "expire": "seconds without a message after which the property is removed",
    "feedback": "properties from the feedback of the goal",
    "fields": "values in order: paths of fields of the message",
    "frame": "the only accepted frame of messages",
    "goal": "fields of the goal, with values or `$parameter`",
    "lateness": "seconds to wait for late messages",
    "latest_only": "newest-only delivery (default: true); false delivers all changes",
    "least": "replaces smaller numbers of the agent",
    "maximum": "greatest value of a number",
    "meanwhile": "observations that make the operation fail while it runs",
    "minimum": "smallest value of a number",
    "mode": "`verbose` (default), or `on_demand`: updated only by operations with `refresh`",
    "name": "name of the value in descriptions",
    "names": "atoms for values, such as `{0: off, 1: on}`",
    "node": "the node that has the parameter (default: our own)",
    "offers": "types of the goals and beliefs that agents offer to the graph",
    "offset": "added after `scale`",
    "otherwise": "substitute for numbers that are not finite and for missing elements",
    "outputs": "fields of the answer, which the caller gets in variables",
    "parameter": "its name in the graph (default: the property's)",
    "parameters": "names of the arguments; write `$name` for one in values",
    "path": "path of a field, such as `pose.pose.position.x`",
    "publish": "topic on which a message is published",
    "qos": "quality of service",
    "rate": "times per second",
    "read_only": "the parameter cannot change after the start",
    "refresh": "properties to update to the newest values",
    "request": "fields of the request, with values or `$parameter`",
    "result": "fields of the result",
    "roles": "roles of all callers in the graph (default: `user`)",
    "round": "decimals; `down` rounds to the integer below",
    "sample": "number of elements of a list, evenly spread, or their positions from 0 to 1",
    "scale": "factor: the agent's value is scale * value + offset",
    "service": "name of the service",
    "set_parameter": "name of the parameter",
    "source": "frame whose pose it is",
    "success": "field of the answer that says whether it succeeded",
    "suspend": "what happens to the goal while the intention is suspended",
    "target": "frame in which the pose is",
    "timeout": "seconds until it fails",
    "topic": "name of the topic",
    "type": "type, such as `nav_msgs/msg/Odometry`",
    "unit": "unit for the agent",
    "uses": "resources that no other operation may use meanwhile, such as `wheels`",
    "value": "value, or `$parameter`",
    "when_changed": "send it only when the values have changed",
}
"""The keys of mapping files below artifacts, except those of derived properties' operators."""
WORDS: Mapping[str, Schema] = {
    "as": {"enum": list(fields.KINDS)},
    "mode": {"enum": ["verbose", "on_demand"]},
    "qos": QOS,
    "suspend": {"enum": ["cancel", "go_on"]},
    "unit": {"enum": list(fields.UNITS)},
    **dict.fromkeys(("latest_only", "read_only", "when_changed"), SWITCH),
}
"""The values of keys that have a choice."""


def keys_of(keys: Iterable[str], *required: str) -> Schema:
    """Return the schema of a mapping with these keys."""
    found = {each: {**WORDS.get(each, ANYTHING), **_meaning(each)} for each in keys}
    return mapping(found, required)


def _meaning(key: str) -> Schema:
    return {"description": MEANINGS[key]} if key in MEANINGS else {}


def mappings() -> Schema:
    """Return the schema of mapping files: the parts of one artifact, or ``artifacts``."""
    value = {"type": ["string", "number", "boolean", "null"]}
    values = {"anyOf": [value, {"type": "array"}]}
    field = {"anyOf": [value, keys_of(fields.FIELD, "path")]}
    of_message = {"fields": {"anyOf": [field, listed(field)], **_meaning("fields")}}
    topic = [
        {**each, "properties": {**each["properties"], **of_message}}
        for each in (keys_of(properties.PROPERTY, "topic"), keys_of(properties.SIGNAL, "topic"))
    ]
    kinds = [keys_of([*keys, *operations.COMMON], kind) for kind, keys in operations.KEYS.items()]
    derived = [
        keys_of([name, *shape.required, *shape.optional, *properties.DERIVED], name)
        for name, shape in OPERATORS.items()
    ]
    own = {
        "properties": named({"anyOf": [TEXT, topic[0]]}),
        "signals": named({"anyOf": [TEXT, topic[1]]}),
        "frames": named(keys_of(properties.FRAME, "target", "source")),
        "parameters": named({"anyOf": [values, keys_of(properties.OWN, "default")]}),
        "derived": named({"anyOf": derived}),
        "operations": named({"anyOf": [*kinds, listed({"anyOf": kinds})]}),
    }
    artifact = declared(ArtifactPart("", fields.START), **own)
    offer = [keys_of(keys, "type") for keys in (offers.OF_ACTION, offers.OF_TOPIC)]
    roles = {"anyOf": [TEXT, listed(TEXT)], **_meaning("roles")}
    of_file = {"offers": {**named({"anyOf": offer}), **_meaning("offers")}, "roles": roles}
    several = {**artifact["properties"], **of_file, "artifacts": named(artifact)}
    return mapping(several)


SCHEMAS = {"world": worlds, "faults": faults, "mapping": mappings}
