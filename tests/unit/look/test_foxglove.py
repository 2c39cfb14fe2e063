"""Recordings for Foxglove, as a reader of MCAP files finds them."""

import io
import json
from typing import Any, NamedTuple

from mcap.reader import make_reader

from jacaros.look.out.foxglove import layout, write_mcap
from jacaros.look.records.recording import Recording
from jacaros.look.records.records import Frame
from jacaros.robots.world.data.ground_truth import RobotState


class Read(NamedTuple):
    """A message of a file."""

    t: float
    topic: str
    schema: str
    content: Any


def messages(data: bytes) -> list[Read]:
    """The messages of a file, whose checksums must be right."""
    return [
        Read(each.log_time / 1e9, channel.topic, schema.name, json.loads(each.data))
        for schema, channel, each in make_reader(io.BytesIO(data), validate_crcs=True).iter_messages()
        if schema is not None
    ]


def written(recording: Recording) -> tuple[list[Read], dict[str, Any]]:
    file = io.BytesIO()
    shown = layout(recording, write_mcap(recording, file))
    return messages(file.getvalue()), shown


def event(t: float, kind: str, **data: Any) -> tuple[float, str, dict[str, Any]]:
    return t, kind, {"agent": "guard", **data}


def intention(t: float, number: int, goal: str = "", **more: Any) -> tuple[float, str, dict[str, Any]]:
    return event(t, "intention", id=number, stack=[{"goal": goal}] if goal else None, **more)


RECORDING = Recording(
    world={"robots": [{"name": "r2 d2"}]},
    frames=[Frame(0.5, [RobotState(1.0, 2.0, 0.0, 90.0, False, False)])],
    texts=[(1.0, "guard", "hello")],
    events=[
        event(
            0.0,
            "program",
            plans=[],
            thresholds=[{"belief": "battery", "argument": 0, "value": 20, "rule": "low"}],
        ),
        event(0.0, "belief", op="+", belief="battery(80,low)"),
        intention(0.0, 1, "!patrol(1)", state="waits", waits="the action go(1)"),
        intention(1.0, 2, "+!patrol(2)[source(self)]", state="runs"),
        event(1.5, "operation", id=9, artifact="/main/wheels", operation="go(1)", state="began"),
        intention(2.0, 1, "!patrol(1)", state="suspended", reason="needs wheels"),
        event(
            2.5,
            "operation",
            id=9,
            artifact="/main/wheels",
            operation="go(1)",
            state="failed",
            reason="stuck\nhere",
        ),
        event(3.0, "goal", goal="!patrol(1)", state="failed", intention=1),
        intention(3.0, 1, state="over"),
        intention(4.0, 2, state="over"),
        event(3.0, "resource", resource="wheels", holder="[guard] !go(dock)"),
        event(3.5, "resource", resource="wheels", holder=None),
        event(4.0, "log", level="warning", text="lost"),
        event(5.0, "laser", robot="r2 d2", step=0.5, ranges=[100, 0], **{"from": -1.0}),
    ],
)


def of(topic: str) -> list[Any]:
    return [each.content for each in written(RECORDING)[0] if each.topic == topic]


def test_a_lane_shows_one_intention_at_a_time() -> None:
    first = ["waits for the action go(1)", "suspended: needs wheels", "failed: !patrol(1)"]
    assert [each["now"] for each in of("/intentions/guard/patrol")] == first
    assert [each["now"] for each in of("/intentions/guard/patrol_2")] == ["+!patrol(2)[source(self)]", ""]


def test_operations_resources_numbers_output_and_robots_have_topics() -> None:
    assert [each["now"] for each in of("/operations/wheels")] == ["go(1)", "failed: stuck"]
    assert [each["now"] for each in of("/resources/wheels")] == ["[guard] !go(dock)", ""]
    assert of("/beliefs/guard/battery") == [{"arg1": 80}]
    assert of("/robots/r2_d2") == [{"x": 1.0, "y": 2.0, "yaw": 0.0, "battery": 90.0, "speed": 0.0}]
    assert [(each["level"], each["name"], each["message"]) for each in of("/log")] == [
        (2, "guard", "hello"),
        (3, "run", "lost"),
    ]
    (scan,) = of("/robots/r2_d2/laser")
    assert (scan["frame_id"], scan["end_angle"], scan["ranges"]) == ("r2 d2", -0.5, [1.0, 0.0])
    assert of("/transforms")[0]["transforms"][0]["child_frame_id"] == "r2 d2"


def test_the_layout_shows_topics_of_the_file() -> None:
    found, shown = written(RECORDING)
    panels = shown["configById"]
    paths = [each["value"] for panel in panels.values() for each in panel.get("paths", ())]
    assert "20" in paths  # the limit of the battery
    fields = {f"{each.topic}.{field}" for each in found for field in each.content}
    assert {*paths} - {"20"} <= fields
    assert {*panels["3D!map"]["topics"]} <= {each.topic for each in found}
    assert json.dumps(shown["layout"]).count("!") == len(panels)


def test_a_recording_without_events_is_a_file() -> None:
    assert written(Recording())[0] == []
