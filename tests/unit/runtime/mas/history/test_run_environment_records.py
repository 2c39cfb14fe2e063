"""Records of the environment of a run: artifacts, operations, commands, robots, the ROS graph, and the log."""

import re
from pathlib import Path
from typing import Any

from observed_runs import records_of

from jacaros import Mas
from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.mas.history.run_environment import RobotRecords

LAMPS = """
from jacaros.artifacts import Artifact, operation

class Lamp(Artifact):
    def init(self):
        self.define_property("power", 0)

    @operation
    def switch(self, power):
        self.update_property("power", power)
        self.signal("switched", power, "by hand")

    @operation
    async def fade(self):
        for power in range(100):
            await self.sleep(0.01)
            self.update_property("power", power)

    @operation
    async def burn(self):
        await self.sleep(100)

    @operation
    def break_it(self):
        self.fail("it is of glass", "broken", 3)

    @operation
    def say(self, words):
        self.define_property("said", words)
"""

Happened = list[tuple[float, str, Any]]


def happened(
    folder: Path, program: str, seconds: float, files: dict[str, str] | None = None, **options: Any
) -> Happened:
    """Run one agent for some seconds and return the records."""
    for name, text in (files or {}).items():
        (folder / name).write_text(text, encoding="utf-8")
    return records_of({"ann": program}, seconds, folder=folder, **options)


def of(found: Happened, event: str, **fields: Any) -> list[dict[str, Any]]:
    return [
        data
        for _, kind, data in found
        if kind == event and all(data.get(name) == value for name, value in fields.items())
    ]


def test_an_artifact_is_recorded_from_creation_to_disposal(tmp_path: Path) -> None:
    steps = 'makeArtifact(lamp, "Lamp", [], L); focus(L); switch(3); stopFocus(L); disposeArtifact(L)'
    program = f"!start. +!start <- {steps}."
    found = happened(tmp_path, program, 1, {"artifacts.py": LAMPS})
    lamp = [each for each in found if each[2].get("artifact") == "/main/lamp"]
    (_, kind, made), *_ = [each for each in lamp if each[1] not in ("cause", "operation")]
    assert kind == "artifact"
    assert made == {"artifact": "/main/lamp", "type": "Lamp", "state": "made", "robot": None}
    assert of(lamp, "property")[0]["values"] == [0]
    focus = {"agent": "ann", "artifact": "/main/lamp"}
    assert of(found, "focus") == [{**focus, "on": True}, {**focus, "on": False}]
    [signal] = of(found, "signal")
    assert signal["signal"] == 'switched(3,"by hand")'
    began, done = of(found, "operation", operation="switch(3)")
    assert (began["state"], done["state"], began["agent"]) == ("began", "done", "ann")
    assert began["id"] == done["id"] != 0
    assert of(found, "artifact", artifact="/main/lamp", state="disposed")


def test_a_property_that_changes_continuously_is_recorded_periodically_and_at_the_end(tmp_path: Path) -> None:
    program = '!start. +!start <- makeArtifact(lamp, "Lamp", [], L); fade.'
    found = happened(tmp_path, program, 3, {"artifacts.py": LAMPS})
    power = of(found, "property", name="power")
    assert power[0]["values"] == [0]
    assert power[-1]["values"] == [99]
    assert 3 <= len(power) <= 6


def test_an_operation_fails_with_its_reason_or_because_it_is_cancelled(tmp_path: Path) -> None:
    program = """
        !start.
        +!start <- makeArtifact(lamp, "Lamp", [], L); !!long; !broken.
        +!long <- burn.
        +!broken <- break_it.
        -!broken <- .drop_intention(long).
    """
    found = happened(tmp_path, program, 1, {"artifacts.py": LAMPS})
    reasons = [each["reason"] for each in of(found, "operation", state="failed")]
    assert reasons == ["it is of glass", "cancelled"]


def test_owners_of_a_resource_are_recorded_when_they_change(tmp_path: Path) -> None:
    program = """
        !tidy. !alarm.
        @tidy[needs(arm)] +!tidy <- .wait(1000).
        +!alarm <- .wait(300); !flee.
        @flee[needs(arm), urgency(5)] +!flee <- .wait(200).
    """
    found = happened(tmp_path, program, 3)
    owners = [(t, data["holder"]) for t, kind, data in found if kind == "resource"]
    assert owners == [(0.0, "[ann] !tidy"), (0.3, "[ann] !flee"), (0.5, "[ann] !tidy"), (1.0, None)]
    assert {each["resource"] for each in of(found, "resource")} == {"arm"}


def test_recorded_values_are_limited(tmp_path: Path) -> None:
    program = f'!s. +!s <- makeArtifact(lamp, "Lamp", [], L); say("{"x" * 5000}").'
    found = happened(tmp_path, program, 1, {"artifacts.py": LAMPS})
    [said] = of(found, "property", name="said")
    assert len(said["values"][0]) == 1000
    assert all(len(each["operation"]) <= 200 for each in of(found, "operation"))


DRIVE = '!start. +!start <- makeArtifact(wheels, "ArtCmdVel", [], W); moveForward(1); .wait(1000).'


def test_a_command_is_linked_to_the_operation_and_the_act_behind_it(tmp_path: Path) -> None:
    found = happened(tmp_path, DRIVE, 8)
    links = {each["id"]: each for each in of(found, "cause")}
    commands = [each for each in links.values() if each["kind"] == "command"]
    for command in commands:
        operation = links[command["parent"]]
        assert (operation["kind"], operation["what"]) == ("operation", "moveForward(1)")
        act = links[operation["parent"]]
        assert (act["kind"], act["agent"]) == ("act", "ann")
        assert command["topic"] == "/cmd_vel"
    speeds = [re.search(r"linear.x=([\d.]+)", each["what"]) for each in commands]
    assert max(float(speed[1]) for speed in speeds if speed) > 0.1
    assert commands[-1]["what"] == "/cmd_vel", "the last command, zero, is recorded"
    assert len(commands) < 2 * 8 + 2, "a stream of commands is thinned"
    [wheels] = of(found, "artifact", artifact="/main/wheels", state="made")
    assert wheels["robot"] == "turtlebot"
    samples = [each for each in links.values() if each["kind"] == "sample"]
    assert not samples, "messages without effect are not recorded"


def test_a_scan_is_recorded_only_while_an_artifact_listens(tmp_path: Path) -> None:
    listens = '!s. +!s <- makeArtifact(laser, "ArtBaseScan", [], L); focus(L).'
    scans = of(happened(tmp_path, listens, 4, world="patrol"), "laser")
    assert 10 < len(scans) <= 40
    assert scans[0]["robot"] == "turtlebot"
    assert 0 < len(scans[0]["ranges"]) <= 90
    assert any(scans[0]["ranges"])
    assert all(isinstance(each, int) for each in scans[0]["ranges"])
    assert of(happened(tmp_path, DRIVE, 4), "laser") == []


def test_the_path_of_embedded_navigation_is_recorded_until_the_robot_arrives() -> None:
    told: list[tuple[str, Any]] = []

    class Robots:
        way: tuple[tuple[float, float], ...] = ()
        belief = (0.0, 0.0, 0.0)

        def paths(self) -> dict[str, Any]:
            return {"rob": self.way}

        def beliefs(self) -> dict[str, Any]:
            return {"rob": self.belief}

    def record(record: Any) -> None:
        told.append((record.kind, record.plain()))

    robots = Robots()
    there = {"rob": (0.0, 0.0, 0.0)}
    records = RobotRecords(VirtualClock(), record, str, lambda: robots, lambda: there)
    records.look()
    robots.way = ((0.0, 0.0), (1.0, 2.00049))
    records.look()
    records.look()
    robots.way, robots.belief = (), (0.2, 0.0, 0.1)
    records.look()
    robots.belief = (0.01, 0.0, 6.28)
    records.look()
    records.look()
    assert told == [
        ("path", {"robot": "rob", "points": [(0.0, 0.0), (1.0, 2.0)]}),
        ("path", {"robot": "rob", "points": []}),
        ("believed", {"robot": "rob", "x": 0.2, "y": 0.0, "yaw": 0.1}),
        ("believed", {"robot": "rob", "x": None, "y": None, "yaw": None}),
    ]


def test_the_graph_around_our_node_is_recorded_with_rates(tmp_path: Path) -> None:
    found = happened(tmp_path, '!s. +!s <- makeArtifact(odom, "ArtOdometry", [], O); .wait(10000).', 8)
    graphs = of(found, "graph")
    assert graphs
    topics = {each["name"]: each for each in graphs[-1]["topics"]}
    assert topics["/odom"]["ours"] == "in"
    assert topics["/odom"]["rate"] > 10
    assert topics["/odom"]["publishers"] == 1
    assert topics["/scan"]["ours"] == ""
    assert len(graphs) <= 2, "nothing has changed"


def test_a_message_for_two_artifacts_counts_once_in_the_rate(tmp_path: Path) -> None:
    def rate(program: str) -> float:
        topics = of(happened(tmp_path, program, 8), "graph")[-1]["topics"]
        return float(next(each["rate"] for each in topics if each["name"] == "/odom"))

    one = '!s. +!s <- makeArtifact(odom, "ArtOdometry", [], O); .wait(10000).'
    two = '!s. +!s <- makeArtifact(a, "ArtOdometry", [], A); makeArtifact(b, "ArtOdometry", [], B); .wait(10000).'
    assert abs(rate(one) - rate(two)) < 1.0


def test_lines_of_the_log_are_recorded(tmp_path: Path) -> None:
    logged = of(happened(tmp_path, "!s. +!s <- !lost.", 1), "log")
    assert any("lost" in each["text"] for each in logged)
    assert {each["level"] for each in logged} <= {"info", "warning", "error"}


async def test_nothing_is_linked_without_a_listener(tmp_path: Path) -> None:
    (tmp_path / "artifacts.py").write_text(LAMPS, encoding="utf-8")
    async with Mas(seed=1, folder=tmp_path, on_print=lambda agent, text: None) as mas:
        mas.add_agent("ann", '!s. +!s <- makeArtifact(lamp, "Lamp", [], L); switch(1).')
        await mas.sleep(1)
        environment = mas.system.environment
        assert environment is not None
        assert environment.tracer is None
        assert environment.listener is None
