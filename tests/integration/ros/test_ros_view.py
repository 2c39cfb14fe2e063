"""A run on a real graph is recorded with the map and the robot that the graph tells of."""

import math
from pathlib import Path

from processes import WorldProcess

from jacaros.look import Recording
from jacaros.runtime.errors import JacarosError


def test_a_recording_has_the_map_and_the_robot(world: WorldProcess, run_agents, tmp_path: Path) -> None:
    record, replay = tmp_path / "run.jsonl", tmp_path / "run.html"
    agents = run_agents("patrol.asl", "--record", str(record), "--replay", str(replay))

    def has_seen_it_drive() -> bool:
        try:
            seen = Recording.read(record)
        except (FileNotFoundError, JacarosError):  # no world in it yet: the graph has not told of one
            return False
        rows = [frame.robots[0] for frame in seen.frames if frame.robots]
        places = {(row.x, row.y) for row in rows}
        return seen.world.get("bounds") == [-1, -1, 4, 2] and len(places) > 5 and rows[-1].battery > 0

    agents.until(has_seen_it_drive, "the robot's way is recorded")
    # The page looks for topics every three seconds; a robot whose scan comes late is seen without it until then.
    agents.until(
        lambda: any(event == "laser" for _, event, _ in Recording.read(record).events),
        "the laser is recorded",
    )
    agents.stop()
    truth = world.close()
    recording = Recording.read(record)
    assert recording.robots == ["robot"]
    robot = recording.frames[-1].robots[0]
    assert min(math.hypot(robot.x - sample.x, robot.y - sample.y) for sample in truth.path()) < 0.3
    assert 0 < robot.battery <= 100
    assert replay.read_text(encoding="utf-8").startswith("<!doctype html>")
