"""A service that refuses, fails, never answers or does not exist, while the robot drives."""

import asyncio
from typing import Any

import pytest
from faults_lab import Lab, in_lab

TRIGGER = "std_srvs/srv/Trigger"


async def never(request: Any) -> Any:
    await asyncio.Event().wait()


def refuse(request: Any) -> Any:
    return {"success": False, "message": "jammed"}


def fail(request: Any) -> Any:
    raise ValueError("no such motor")


def succeed(request: Any) -> Any:
    return {"success": True}


@pytest.mark.parametrize(
    ("handler", "reason", "times"),
    [
        (refuse, 'service_refused(open_gripper,"jammed")', 5),
        (fail, "service_failed(open_gripper)", 5),
        (never, "service_timeout(3)", 1),
        (None, "service_unavailable(open_gripper)", 1),
    ],
    ids=["refuses", "fails", "never answers", "is not there"],
)
def test_a_failing_service_blocks_nothing_and_is_used_again_when_it_works(handler, reason, times) -> None:
    def faults(lab: Lab) -> None:
        node = lab.node("gripper")
        bad = node.service("/open_gripper", TRIGGER, handler) if handler else None

        def mend() -> None:
            if bad is not None:
                lab.graph.vanish("/open_gripper")
            node.service("/open_gripper", TRIGGER, succeed)

        lab.at(4.5, mend)

    lab = in_lab("gripping.asl", faults, mapping="robot.yaml")
    told = [line for line in lab.lines if line.startswith("action_failed")]
    assert told[:times] == [f"action_failed {reason}"] * times
    assert lab.lines[-2:] == ["open", "at 2 0"] or lab.lines[-1] == "open"
    assert lab.when("at 2 0") < 6, "the robot was not held up"
    assert (lab.exit_code, lab.place[1], lab.safe) == (0, 0, True)
    assert lab.place[0] == pytest.approx(2.0, abs=0.05)
