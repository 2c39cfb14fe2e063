"""A run in the message types that Foxglove displays without configuration, as data for JSON."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from jacaros.sim.data.ground_truth import RobotState

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
