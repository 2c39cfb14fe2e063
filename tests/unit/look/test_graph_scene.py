"""The world as seen in a graph: drawn maps and perceived robots."""

import json
import math
from collections.abc import Awaitable, Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.look.page.graph_scene import GraphScene, can_be_drawn, map_drawing
from jacaros.look.page.page import frames, lines_of
from jacaros.look.page.picture import picture_svg
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import UNKNOWN
from jacaros.look.page.watch import Watch
from jacaros.look.records.recording import Recording
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import VirtualClock, run
from played import played

PICTURE = """
?????????
?.......?
?.###...?
?.#.#.#.?
?.###...?
?.......?
?????????
"""


def grid(picture: str, size: float = 0.5, x: float = 1.0, y: float = -1.0, yaw: float = 0.0) -> Any:
    rows = picture.split()[::-1]
    data = [{"?": -1, ".": 0, "#": 100}[cell] for row in rows for cell in row]
    turn = SimpleNamespace(x=0.0, y=0.0, z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    origin = SimpleNamespace(position=SimpleNamespace(x=x, y=y, z=0.0), orientation=turn)
    info = SimpleNamespace(resolution=size, width=len(rows[0]), height=len(rows), origin=origin)
    return SimpleNamespace(info=info, data=data)


def test_a_map_is_drawn_as_outlines_and_boxes() -> None:
    drawing = map_drawing(grid(PICTURE), "hall")
    assert drawing["name"] == "hall"
    # One cell of nothing known around it.
    assert drawing["bounds"] == [1.5, -0.5, 5.0, 2.0]
    ring = [[2, 0, 3.5, 0], [2, 1.5, 3.5, 1.5], [2, 0, 2, 1.5], [3.5, 0, 3.5, 1.5]]
    hole = [[2.5, 0.5, 3, 0.5], [2.5, 1, 3, 1], [2.5, 0.5, 2.5, 1], [3, 0.5, 3, 1]]
    pillar = [[4, 0.5, 4.5, 0.5], [4, 1, 4.5, 1], [4, 0.5, 4, 1], [4.5, 0.5, 4.5, 1]]
    assert sorted(drawing["walls"]) == sorted(ring + hole + pillar)
    area = sum((right - left) * (top - bottom) for left, bottom, right, top in drawing["boxes"])
    assert area == pytest.approx(9 * 0.25)
    assert [4, 0.5, 4.5, 1] in drawing["boxes"]


def test_a_rotated_map_has_only_outlines() -> None:
    drawing = map_drawing(grid(PICTURE, yaw=math.pi / 2))
    assert drawing["boxes"] == []
    assert drawing["bounds"] == pytest.approx([-2.0, -0.5, 0.5, 3.0])
    assert any(wall == pytest.approx([-0.5, 2.0, -1.0, 2.0]) for wall in drawing["walls"])


def test_an_empty_map_is_drawn() -> None:
    drawing = map_drawing(grid("??\n??"))
    assert drawing["walls"] == drawing["boxes"] == []
    assert drawing["bounds"] == [1.0, -1.0, 2.0, 0.0]


def looking(world_name: str, test: Callable[[Any], Awaitable[None]]) -> None:
    clock = VirtualClock()

    async def main() -> None:
        backend = open_backend("memory", clock, "agents")
        beside = open_backend("memory", clock, "world", graph=backend.graph)  # type: ignore[attr-defined]
        await backend.start()
        await beside.start()
        world = World.load(world_name)
        node = SimNode(world, beside, clock)
        await test(SimpleNamespace(clock=clock, world=world, backend=backend, node=node))
        node.close()
        await beside.close()
        await backend.close()

    run(main, clock)


@played(looking, "three_robots")
async def test_robots_are_shown_at_their_estimated_poses(lab) -> None:
    scene = GraphScene(lab.backend, lab.clock, "storehouse")
    await lab.clock.sleep(1.0)
    assert scene.drawing() is None
    assert scene.robots() == []
    lab.node.start()
    await lab.clock.sleep(10.0)
    drawing = scene.drawing()
    assert drawing is not None
    assert drawing is scene.drawing()
    assert drawing["bounds"] == pytest.approx([-4, -3, 4, 3])
    assert [robot["name"] for robot in drawing["robots"]] == ["robot_1", "robot_2", "robot_3"]
    for seen, level in zip(scene.robots(), (100, 75, 50), strict=True):
        true = lab.world.robot(seen.name)
        assert (seen.x, seen.y, seen.yaw) == pytest.approx((true.x, true.y, true.yaw), abs=1e-3)
        assert level - 2 < seen.battery <= level
        assert not seen.charging
    scene.close()


def odometry(lab: Any) -> Callable[..., None]:
    """Publish odometry; numbers that are left out are those of a robot at rest that looks along x."""
    publisher = lab.backend.publisher("/odom", "nav_msgs/msg/Odometry")

    def publish(x: float, z: float = 0.0, w: float = 1.0) -> None:
        publisher.publish({"pose": {"pose": {"position": {"x": x}, "orientation": {"z": z, "w": w}}}})

    return publish


@played(looking, "empty")
async def test_odometry_alone_is_enough(lab) -> None:
    """No map, no tf, no battery."""
    publish = odometry(lab)
    scene = GraphScene(lab.backend, lab.clock)
    for _ in range(50):
        publish(4.0, z=1.0, w=0.0)
        await lab.clock.sleep(0.1)
    (seen,) = scene.robots()
    assert (seen.name, seen.x, seen.y, seen.battery) == ("robot", 4.0, 0.0, UNKNOWN)
    drawing = scene.drawing()
    assert drawing is not None
    assert drawing["bounds"] == [1, -3, 7, 3]
    scene.close()


@played(looking, "empty")
async def test_nan_and_infinity_are_not_drawn(lab) -> None:
    """Neither by a view, which nothing else draws, nor in a recording: JSON has no such numbers."""
    publish = odometry(lab)
    scene = GraphScene(lab.backend, lab.clock)
    await lab.clock.sleep(5.0)
    for x, z, seen in ((math.nan, 0.0, []), (1.0, math.nan, []), (4.0, 0.0, [4.0]), (math.inf, 0.0, [4.0])):
        publish(x, z)
        await lab.clock.sleep(0.1)
        assert [robot.x for robot in scene.robots()] == seen
    scene.close()


@pytest.mark.parametrize(
    "change", [{"width": 4}, {"width": 0, "height": 0}, {"resolution": 0.0}, {"resolution": math.nan}]
)
def test_an_invalid_map_is_not_drawn(change: dict[str, Any]) -> None:
    message = grid("##\n##")
    assert can_be_drawn(message)
    vars(message.info).update(change)
    assert not can_be_drawn(message)
    assert not can_be_drawn(grid("##\n##", x=math.nan)), "an origin"


@played(looking, "two_robots")
async def test_a_world_discovered_late_is_recorded(lab, tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    recorder = Recorder(path)
    watch = Watch(lab.clock, [recorder], GraphScene(lab.backend, lab.clock, "late"))
    watch.start()
    await lab.clock.sleep(1.0)
    lab.node.start()
    await lab.clock.sleep(10.0)
    watch.stop()
    recorder.close()
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    assert lines[0] == {"kind": "world", "version": 2, "world": {}}
    recording = Recording.read(path)
    assert recording.robots == ["robot_0", "robot_1"]
    shown = frames(recording)
    assert next(lines_of(recording)).world["name"] == "late"
    for robot, x in zip(shown["robots"], (-1000, 1000), strict=True):
        assert 0 < len(robot["x"]) < len(shown["t"]), "nothing was known at first"
        assert robot["x"][0] == x
        assert set(robot["x"][1:]) == {0}
    picture = picture_svg(recording)
    assert picture.count('class="robot"') == 2
    assert ">robot_1</text>" in picture


def test_a_recording_without_a_world_has_a_picture() -> None:
    assert "<svg" in picture_svg(Recording())
