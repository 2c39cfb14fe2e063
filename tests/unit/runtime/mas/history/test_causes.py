"""Chains of causes: what is kept until something needs it, and which commands are recorded."""

import math
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.look.records.words import message_text
from jacaros.look.why.why import explain
from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.mas.history import causes
from jacaros.runtime.mas.history.causes import COMMAND_PERIOD, CauseRecords


def recorder() -> tuple[CauseRecords, list[dict[str, Any]], VirtualClock]:
    """Records of causes, the list that they are written to, and their clock."""
    clock, told = VirtualClock(), []
    return CauseRecords(clock, clock.now(), lambda record: told.append(record.plain())), told, clock


def twist(x: float) -> Any:
    """A velocity command."""
    still = {"y": 0.0, "z": 0.0}
    return SimpleNamespace(linear=SimpleNamespace(x=x, **still), angular=SimpleNamespace(x=0.0, **still))


def test_a_cause_of_the_generation_before_is_still_known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(causes, "_GENERATION", 3)
    records, told, _ = recorder()
    first = records.link("step", "first")
    for number in range(5):
        records.link("step", str(number))
    records.need(first)
    assert [each["what"] for each in told] == ["first"]


def test_a_command_to_stop_is_recorded_at_once() -> None:
    records, told, clock = recorder()
    operation = records.link("operation", "moveForward")
    for x in (0.2, 0.2, 0.2, 0.0, 0.0):
        records.sent_message("/cmd_vel", twist(x), operation)
        clock.advance(0.01)
    commands = [each["at"] for each in told if each["kind"] == "command"]
    assert commands == [0.0, 0.03]
    clock.advance(COMMAND_PERIOD)
    records.flush()
    assert len([each for each in told if each["kind"] == "command"]) == 3


def command(number: int, t: float, x: float) -> tuple[float, str, dict[str, Any]]:
    """The record of a command."""
    data = {"kind": "command", "what": f"/cmd_vel: linear.x={x}", "topic": "/cmd_vel", "at": t}
    return t, "cause", {"id": number, "parent": 0, **data}


def test_the_robot_stopped_at_the_first_command_after_its_last_motion() -> None:
    records = [command(number, float(number), x) for number, x in enumerate((0.0, 0.3, 0.0, 0.0), 1)]
    records.append((9.0, "agent", {"agent": "ann", "state": "began"}))
    assert explain(records, "stopped").text().startswith("the robot stopped at 3.000 s")


def test_the_outcome_of_a_goal_is_that_of_its_own_agent() -> None:
    deliberation = {"id": 7, "agent": "ann", "trigger": "+!go", "chosen": None, "options": []}
    records = [
        *((0.0, "agent", {"agent": name, "state": "began"}) for name in ("ann", "bob")),
        (1.0, "deliberation", deliberation),
        (2.0, "goal", {"agent": "bob", "goal": "!go", "id": 1, "state": "achieved"}),
        (3.0, "goal", {"agent": "ann", "goal": "!go", "id": 2, "state": "failed", "why": "no_way"}),
    ]
    answer = explain(records, "!go", agent="ann").text()
    assert "!go failed at 3.000 s: no_way" in answer
    assert "achieved" not in answer


@dataclass
class Battery:
    voltage: float = 15.9
    current: float = math.nan
    percentage: float = 0.7965
    present: bool = True


@dataclass
class Robot:
    name: str = "r1"
    mode: str = "idle"
    battery: Battery = field(default_factory=Battery)


@pytest.mark.parametrize(
    ("message", "effect", "text"),
    [
        (Battery(), [], "voltage=15.9, percentage=0.7965, present=True, current=nan"),
        (Battery(), [79], "percentage=0.7965, voltage=15.9, present=True, current=nan"),
        (Battery(), [15.9, 0.7965], "voltage=15.9, percentage=0.7965, present=True, current=nan"),
        (Robot(), ["idle"], "mode=idle, name=r1, battery.voltage=15.9, battery.percentage=0.7965"),
        (Robot(), [0, "", 80], "battery.percentage=0.7965, name=r1, mode=idle, battery.voltage=15.9"),
    ],
)
def test_a_message_shows_the_fields_first_that_its_effect_came_from(
    message: Any, effect: list[object], text: str
) -> None:
    assert message_text(message, effect).startswith(text)
