"""A recording for Foxglove: lanes, numbers, output, poses and laser scans as MCAP, and a layout that shows them."""

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from heapq import merge
from itertools import chain, count
from typing import Any, BinaryIO

from jacaros.look.out.limits import limits
from jacaros.look.out.mcap_file import Message, write_messages
from jacaros.look.out.series import ROBOT_FIELDS, all_series, samples
from jacaros.look.records.recording import Recording

_WORLD = "map"
"""Frame of the world; the frame of each robot has the robot's name."""
_LEVELS = {"info": 2, "warning": 3, "error": 4}
_MOST_LANES = 30
_ZERO = {"x": 0.0, "y": 0.0, "z": 0.0}


def write_mcap(recording: Recording, file: BinaryIO) -> dict[str, str]:
    """Write a recording to an empty file. Return the topics with their schemas. Times count from the start of the run."""
    texts = (_log(t, agent, text, "info") for t, agent, text in recording.texts)
    lanes = _Lanes().messages(recording)
    streams = _numbers(recording), _poses(recording), texts, lanes, _sensed(recording)
    return write_messages(merge(*streams, key=lambda each: each.t), file)


def _topic(*names: str) -> str:
    """Return a topic. Foxglove's message paths allow few signs in it."""
    return "/" + re.sub(r"[^\w/]", "_", "/".join(each.strip("/") for each in names), flags=re.ASCII)


def _numbers(recording: Recording) -> Iterator[Message]:
    """Yield numbers, in fields ``arg1``, ``arg2`` and so on for those of beliefs and properties."""
    folders = {"belief": "beliefs", "property": "properties"}
    for t, source, owner, name, values in samples(recording):
        fields = ROBOT_FIELDS if source == "robot" else (f"arg{place}" for place in count(1))
        numbers = {field: each for field, each in zip(fields, values or (), strict=False) if each is not None}
        if source == "robot" and "x" in numbers:
            yield Message(t, _topic("robots", name), "jacaros.Robot", numbers)
        elif source in folders and numbers:
            topic = _topic(folders[source], owner, name)
            yield Message(t, topic, f"jacaros{topic.replace('/', '.')}", numbers)


class _Lanes:
    """What each intention and operation does, in words. A topic shows one at a time: ``charge``, beside it ``charge_2``."""

    def __init__(self) -> None:
        self._topics: dict[object, str] = {}

    def messages(self, recording: Recording) -> Iterator[Message]:
        failed: dict[object, str] = {}
        for t, kind, data in recording.events:
            if kind == "goal" and data["state"] in ("failed", "recovered"):
                lost = data["goal"] if data["state"] == "failed" else ""
                failed[data["agent"], data.get("intention")] = lost
            elif kind == "intention" and data["state"] == "over":
                key = data["agent"], data["id"]
                yield from self._end(t, key, failed.pop(key, ""))
            elif kind == "intention" and data.get("stack"):
                root = re.sub(r"^[^\w~]*|[(\[].*", "", data["stack"][0]["goal"], flags=re.DOTALL)
                key = data["agent"], data["id"]
                yield self._show(t, key, _topic("intentions", data["agent"], root), _doing(data))
            elif kind == "resource":
                topic = _topic("resources", data["resource"])
                yield Message(t, topic, "jacaros.Lane", {"now": data["holder"] or ""})
            elif kind == "operation" and data["state"] == "began":
                topic = _topic("operations", data["artifact"].rpartition("/")[2])
                yield self._show(t, data["id"], topic, data["operation"])
            elif kind == "operation":
                reason = data.get("reason") or "unknown reason"
                yield from self._end(t, data["id"], reason if data["state"] == "failed" else "")

    def _show(self, t: float, key: object, first: str, now: str) -> Message:
        taken, names = {*self._topics.values()}, chain((first,), (f"{first}_{number}" for number in count(2)))
        topic = self._topics.setdefault(key, next(each for each in names if each not in taken))
        return Message(t, topic, "jacaros.Lane", {"now": now})

    def _end(self, t: float, key: object, failure: str) -> Iterator[Message]:
        if key in self._topics:
            now = failure and f"failed: {failure}".partition("\n")[0]
            yield Message(t, self._topics.pop(key), "jacaros.Lane", {"now": now})


def _doing(data: Mapping[str, Any]) -> str:
    if data["state"] == "suspended":
        return f"suspended: {data.get('reason') or 'by a plan'}"
    return f"waits for {data['waits']}" if data.get("waits") else str(data["stack"][-1]["goal"])


def _log(t: float, name: str, text: str, level: str) -> Message:
    log = {"timestamp": _time(t), "level": _LEVELS.get(level, 2), "message": text, "name": name}
    return Message(t, "/log", "foxglove.Log", {**log, "file": "", "line": 0})


def _poses(recording: Recording) -> Iterator[Message]:
    for frame in recording.frames:
        rows = [
            {
                "timestamp": _time(frame.t),
                "parent_frame_id": _WORLD,
                "child_frame_id": name,
                "translation": {**_ZERO, "x": robot.x, "y": robot.y},
                "rotation": {**_ZERO, "z": math.sin(robot.yaw / 2), "w": math.cos(robot.yaw / 2)},
            }
            for name, robot in zip(recording.robots, frame.robots, strict=False)
        ]
        yield Message(frame.t, "/transforms", "foxglove.FrameTransforms", {"transforms": rows})


def _sensed(recording: Recording) -> Iterator[Message]:
    """Yield laser scans, and what the run logs."""
    origin = {"position": _ZERO, "orientation": {**_ZERO, "w": 1.0}}
    for t, kind, data in recording.events:
        if kind == "log":
            yield _log(t, "run", data["text"], data["level"])
        elif kind == "laser":
            start, ranges = float(data["from"]), [each / 100.0 for each in data["ranges"]]
            end = start + data["step"] * (len(ranges) - 1)
            frame = {"timestamp": _time(t), "frame_id": data["robot"], "pose": origin}
            scan = {**frame, "start_angle": start, "end_angle": end, "ranges": ranges, "intensities": []}
            yield Message(t, _topic("robots", data["robot"], "laser"), "foxglove.LaserScan", scan)


def _time(t: float) -> dict[str, int]:
    return {"sec": int(t), "nsec": round(t % 1.0 * 1e9)}


def layout(recording: Recording, topics: Mapping[str, str]) -> dict[str, Any]:
    """Return a layout for the topics of a file: map, output, lanes, batteries with their limits, and positions."""
    beliefs = [each for each in recording.events if each[1] == "belief"]
    charged = [each for each in beliefs if each[2]["belief"].startswith("battery(")]
    charges = all_series(Recording(events=charged))
    compared = dict(limit for each in charges for limit in limits(recording, each, ()))
    of_schema: dict[str, list[str]] = defaultdict(list)
    for topic, schema in topics.items():
        of_schema[schema].append(topic)
    lanes, robots = of_schema["jacaros.Lane"][:_MOST_LANES], of_schema["jacaros.Robot"]
    drawn = of_schema["foxglove.FrameTransforms"] + of_schema["foxglove.LaserScan"]
    batteries = [f"{_topic('beliefs', each.owner, each.name)}.arg{each.field}" for each in charges]
    # A number as a path is a horizontal line.
    numbers = [
        {**_path(limit.name), "label": label, "lineStyle": "dashed"} for label, limit in compared.items()
    ]
    panels: dict[str, dict[str, Any]] = {
        "3D!map": {"followTf": _WORLD, "topics": {each: {"visible": True} for each in drawn}},
        "RosOut!log": {"topicToRender": "/log", "minLogLevel": 1},
        "StateTransitions!lanes": {"isSynced": True, "paths": [_path(f"{each}.now") for each in lanes]},
        "Plot!battery": _plot([*map(_path, batteries or [f"{each}.battery" for each in robots]), *numbers]),
        "Plot!position": _plot(_path(f"{each}.{axis}") for each in robots for axis in "xy"),
    }
    plots = _split("column", "Plot!battery", "Plot!position")
    sides = _split("column", "3D!map", "RosOut!log"), _split("column", "StateTransitions!lanes", plots)
    shown = {"configById": panels, "layout": _split("row", *sides)}
    return {**shown, "globalVariables": {}, "userNodes": {}, "playbackConfig": {"speed": 1}}


def _plot(paths: Iterable[dict[str, Any]]) -> dict[str, Any]:
    return {"isSynced": True, "showLegend": True, "paths": [{**each, "enabled": True} for each in paths]}


def _path(value: str) -> dict[str, Any]:
    label = re.sub(r"^/\w+/|\.(now|arg1)$", "", value)
    return {"value": value, "label": label, "timestampMethod": "receiveTime"}


def _split(direction: str, first: Any, second: Any) -> dict[str, Any]:
    return {"direction": direction, "first": first, "second": second, "splitPercentage": 50}
