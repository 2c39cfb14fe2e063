"""Recordings in the format of MCAP, read back with the library of the format."""

import json
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

import jacaros
from jacaros import Mas
from jacaros.look import Recorder, Recording, record
from jacaros.runtime.cli.main import main as command
from jacaros.runtime.errors import JacarosError, UsageError

DRIVE = """
    !start.
    +!start
      <- makeArtifact(odometry, "ArtOdometry", [], O); focus(O);
         makeArtifact(wheels, "ArtCmdVel", [], _); moveForward(1); .print("there").
    +odom(X, _, _) : X > 0.5 & not told <- +told; lookupArtifact(wheels, _).
"""


def channels(path: Path) -> dict[str, list[tuple[float, str, Any]]]:
    """Time in seconds, schema and content of each message by topic."""
    found: dict[str, list[tuple[float, str, Any]]] = {}
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert schema is not None
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            assert json.loads(schema.data)["type"] == "object"
            rows = found.setdefault(channel.topic, [])
            rows.append((message.log_time / 1e9, schema.name, json.loads(message.data)))
    return found


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[tuple[float, str, Any]]]:
    path = tmp_path_factory.mktemp("mcap") / "run.mcap"

    async def body() -> None:
        async with Mas(seed=1, world="patrol", on_print=lambda agent, text: None) as mas:
            with record(mas, path):
                mas.add_agent("ann", DRIVE)
                await mas.sleep(8)

    jacaros.run(body(), clock="fast")
    return channels(path)


def test_each_kind_of_record_has_a_channel(driven: dict[str, Any]) -> None:
    assert {
        *("/jacaros/world", "/jacaros/frame", "/jacaros/text", "/jacaros/goal", "/jacaros/artifact"),
        *("/jacaros/operation", "/jacaros/cause"),
    } <= set(driven)
    t, schema, content = driven["/jacaros/goal"][0]
    assert (t, schema, content["goal"]) == (0.0, "jacaros.goal", "!start")


def test_only_messages_with_an_effect_are_recorded(driven: dict[str, Any]) -> None:
    moved = [content["linear"]["x"] for _, _, content in driven["/cmd_vel"]]
    assert max(moved) > 0.1
    assert moved[-1] == 0.0
    assert {schema for _, schema, _ in driven["/cmd_vel"]} == {"geometry_msgs/msg/Twist"}
    assert "/odom" in driven
    xs = [content["pose"]["pose"]["position"]["x"] for _, _, content in driven["/odom"]]
    assert any(x > 0.5 for x in xs)
    assert "/battery_state" not in driven


def test_robots_are_transforms_and_the_world_is_a_scene(driven: dict[str, Any]) -> None:
    _, schema, first = driven["/jacaros/transforms"][0]
    assert schema == "foxglove.FrameTransforms"
    [transform] = first["transforms"]
    assert (transform["parent_frame_id"], transform["child_frame_id"]) == ("map", "turtlebot")
    last = driven["/jacaros/transforms"][-1][2]["transforms"][0]
    assert last["translation"]["x"] - transform["translation"]["x"] == pytest.approx(1.0, abs=0.1)
    _, schema, scene = driven["/jacaros/scene"][-1]
    assert schema == "foxglove.SceneUpdate"
    names = [entity["id"] for entity in scene["entities"]]
    assert names == ["walls", "turtlebot"]
    assert len(scene["entities"][0]["lines"][0]["points"]) > 8
    _, schema, line = driven["/jacaros/output"][0]
    assert (schema, line["name"], line["message"]) == ("foxglove.Log", "ann", "there")


def test_a_long_recording_starts_a_second_complete_part(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    recorder = Recorder(path, limit=1_000_000)
    recorder.world({"name": "nowhere"})
    for number in range(6000):
        recorder.event(number / 10, "noise", {"bits": f"{(number * 2654435761) ** 40:x}"})
    recorder.close()
    parts = channels(path.with_name("run.mcap.1")), channels(path)
    assert [content["part"] > 1 for _, _, content in parts[1]["/jacaros/world"]] == [True]
    numbers = [round(content["t"] * 10) for part in parts for _, _, content in part["/jacaros/noise"]]
    assert numbers == list(range(6000 - len(numbers), 6000))


def test_a_missing_library_suggests_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "jacaros.look.records.mcap_format", None)
    with pytest.raises(UsageError, match=r"pip install 'jacaros\[mcap\]'"):
        Recorder(tmp_path / "run.mcap")
    assert not (tmp_path / "run.mcap").exists()


@pytest.mark.parametrize("name", ["run.mcap", "run.jsonl.gz"])
def test_a_missing_folder_is_reported_before_the_run(tmp_path: Path, name: str, capsys) -> None:
    (tmp_path / "a.asl").write_text('!s. +!s <- .print("begun").', encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        command(["run", str(tmp_path / "a.asl"), "--record", str(tmp_path / "none" / name)])
    assert ended.value.code == 2
    printed = capsys.readouterr()
    assert "begun" not in printed.out
    assert "folder does not exist" in printed.err


def test_reading_an_mcap_recording_reports_that_it_is_unsupported(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "run.mcap")
    recorder.close()
    (tmp_path / "run.mcap").write_bytes(b"\x89MCAP0\r\n")
    with pytest.raises(JacarosError, match=r"--record RUN\.jsonl"):
        Recording.read(tmp_path / "run.mcap")
