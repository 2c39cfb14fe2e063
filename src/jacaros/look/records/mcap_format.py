"""Records and ROS messages in an MCAP file, which Foxglove and ROS's tools open (extra ``mcap``)."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from mcap.writer import CompressionType, Writer

from jacaros.look.records.line_format import encoded
from jacaros.look.records.records import EventLine, Frame, MessageLine, RecordingLine, TextLine, WorldLine
from jacaros.robots.ros.message import plain
from jacaros.robots.world.data.ground_truth import RobotState
from jacaros.version import VERSION as JACAROS

_CHUNK = 1 << 16
"""Chunk size in bytes: complete chunks are readable even after a crash."""

Packed = tuple[str, str, Any]
"""Topic, schema and content of a message in the file."""


class McapFile:
    """A file of MCAP (see `jacaros.look.page.recorder.RecordingFile`).

    Each kind of record has a channel ``/jacaros/KIND``, with JSON and a schema for it.  Robots are transforms, the world is
    a scene and what agents print is a log, as Foxglove shows them.  Messages of ROS keep their topics and types, as JSON.
    Times are those of the records, starting at 0.
    """

    def __init__(self) -> None:
        self._stream = _Taken()
        self._writer = Writer(self._stream, chunk_size=_CHUNK, compression=CompressionType.ZSTD)  # type: ignore[arg-type]  # as much of a file as it needs
        self._writer.start(profile="", library=f"jacaros {JACAROS}")
        self._channels: dict[tuple[str, str], int] = {}
        self._robots: list[str] = []
        self._t = 0.0

    def pack(self, records: Sequence[RecordingLine]) -> bytes:
        """Return the bytes for the records; the last records may wait for a full chunk."""
        for record in records:
            self._t = float(getattr(record, "t", self._t))
            moment = max(0, round(self._t * 1e9))
            for topic, schema, content in self._packed(record):
                channel = self._channel(topic, schema, content)
                self._writer.add_message(channel, moment, encoded(content), moment)
        return self._stream.take()

    def end(self) -> bytes:
        """Return the index of the file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        return self._stream.take()

    def _packed(self, record: RecordingLine) -> Iterator[Packed]:
        match record:
            case MessageLine():
                yield record.topic, record.type, plain(record.message)
            case EventLine():
                yield _own(record.event, {"t": record.t, **record.data})
            case WorldLine(world=world):
                self._robots = [str(robot["name"]) for robot in world.get("robots", ())]
                yield _own("world", {"version": record.version, "part": record.part, "world": world})
                yield "/jacaros/scene", SCENE, scene(world, self._t)
            case Frame(t=t, robots=robots):
                yield _own("frame", {"t": t, "robots": robots})
                yield "/jacaros/transforms", TRANSFORMS, transforms(self._robots, robots, self._t)
            case TextLine(t=t, agent=agent, text=text):
                yield _own("text", {"t": t, "agent": agent, "text": text})
                yield "/jacaros/output", LOG, log_line(agent, text, self._t)

    def _channel(self, topic: str, schema: str, content: Any) -> int:
        known = self._channels.get((topic, schema))
        if known is None:
            shape = encoded({"title": schema, **_schema_of(content)})
            number = self._writer.register_schema(schema, "jsonschema", shape)
            known = self._channels[topic, schema] = self._writer.register_channel(topic, "json", number)
        return known


def _own(kind: str, content: Any) -> Packed:
    return f"/jacaros/{kind}", f"jacaros.{kind}", content


_TIMES = ("timestamp", "lifetime")
_NAMES = {bool: "boolean", int: "number", float: "number", str: "string"}


def _schema_of(content: Any, name: str = "") -> dict[str, Any]:
    """Return a JSON schema that similar content matches; null fields may have any type."""
    if isinstance(content, Mapping):
        title = {"title": "time" if name == "timestamp" else "duration"} if name in _TIMES else {}
        fields = {str(key): _schema_of(each, str(key)) for key, each in content.items()}
        return {"type": "object", **title, "properties": fields}
    if isinstance(content, list | tuple):
        kinds = [_schema_of(each) for each in content[:8]]
        same = kinds and all(kind == kinds[0] for kind in kinds)
        return {"type": "array", "items": kinds[0]} if same else {"type": "array"}
    return {"type": _NAMES[type(content)]} if type(content) in _NAMES else {}


class _Taken:
    """A stream that passes on the bytes written to it."""

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self._size = 0

    def write(self, data: bytes) -> int:
        """Keep *data* until `take`."""
        self._pieces.append(bytes(data))
        self._size += len(data)
        return len(data)

    def tell(self) -> int:
        """Return the number of bytes so far."""
        return self._size

    def flush(self) -> None:
        """Do nothing: there is no buffer."""

    def take(self) -> bytes:
        """Return the bytes written since the last call."""
        pieces, self._pieces = self._pieces, []
        return b"".join(pieces)


# ---- message types that Foxglove displays without configuration

TRANSFORMS, SCENE, LOG = "foxglove.FrameTransforms", "foxglove.SceneUpdate", "foxglove.Log"
WORLD = "map"
"""Frame of the world; the frame of each robot has the robot's name."""
_LINE_LIST = 2
_INFO = 2
_HEIGHT = 0.2
_RADIUS = 0.17
_WALL = {"r": 0.4, "g": 0.4, "b": 0.45, "a": 1.0}
_BODY = {"r": 0.2, "g": 0.5, "b": 0.9, "a": 0.8}
_UPRIGHT = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}


def _time(t: float) -> dict[str, int]:
    seconds = math.floor(t)
    return {"sec": seconds, "nsec": round((t - seconds) * 1e9)}


def _point(x: float, y: float, z: float = 0.0) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def transforms(names: Sequence[str], robots: Sequence[RobotState], t: float) -> dict[str, Any]:
    """Return the poses of robots; *names* of robots discovered late may be missing."""
    found = []
    for index, robot in enumerate(robots):
        found.append(
            {
                "timestamp": _time(t),
                "parent_frame_id": WORLD,
                "child_frame_id": names[index] if index < len(names) else f"robot {index}",
                "translation": _point(robot.x, robot.y),
                "rotation": {"x": 0.0, "y": 0.0, "z": math.sin(robot.yaw / 2), "w": math.cos(robot.yaw / 2)},
            }
        )
    return {"transforms": found}


def scene(world: Mapping[str, Any], t: float) -> dict[str, Any]:
    """Return the walls of a world, and a body for each robot."""
    walls = [_point(x, y) for ax, ay, bx, by in world.get("walls", ()) for x, y in ((ax, ay), (bx, by))]
    lines = {
        "type": _LINE_LIST,
        "pose": {"position": _point(0.0, 0.0), "orientation": _UPRIGHT},
        "thickness": 0.03,
        "scale_invariant": False,
        "points": walls,
        "color": _WALL,
        "colors": [],
        "indices": [],
    }
    entities = [_entity("walls", WORLD, t, {"lines": [lines]})]
    entities += [
        _entity(str(robot["name"]), str(robot["name"]), t, {"cylinders": [_body(robot)]})
        for robot in world.get("robots", ())
    ]
    return {"deletions": [], "entities": entities}


def _body(robot: Mapping[str, Any]) -> dict[str, Any]:
    width = 2.0 * float(robot.get("radius", _RADIUS))
    return {
        "pose": {"position": _point(0.0, 0.0, _HEIGHT / 2), "orientation": _UPRIGHT},
        "size": _point(width, width, _HEIGHT),
        "bottom_scale": 1.0,
        "top_scale": 1.0,
        "color": _BODY,
    }


def _entity(name: str, frame: str, t: float, shapes: Mapping[str, Any]) -> dict[str, Any]:
    kinds = ("arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models")
    return {
        "timestamp": _time(t),
        "frame_id": frame,
        "id": name,
        "lifetime": {"sec": 0, "nsec": 0},
        "frame_locked": True,
        "metadata": [],
        **{kind: shapes.get(kind, []) for kind in kinds},
    }


def log_line(agent: str, text: str, t: float) -> dict[str, Any]:
    """Return an agent's output as a log message."""
    return {"timestamp": _time(t), "level": _INFO, "message": text, "name": agent, "file": "", "line": 0}
