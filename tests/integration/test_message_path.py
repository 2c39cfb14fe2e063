"""The path of a message stays as short as docs/explanation/journey-of-a-message.md says."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import jacaros
from jacaros.robots.ros.drivers.memory.graph import MemoryPublisher
from jacaros.testing import run_project

JOURNEY = Path(__file__).resolve().parents[2] / "docs" / "explanation" / "journey-of-a-message.md"
SOURCES = f"{Path(jacaros.__file__).parent}/"
COUNT = re.compile(r"the message passes (\d+) functions of (\d+) files")

OTHERS = frozenset(
    {
        # the motion that is under way, and what wakes it
        *("Steps._drive", "Motion._drive", "MotionClaim.wait", "MotionClaim.wake"),
        *("WheeledArtifact.perform", "WheeledArtifact.on_odometry"),
        # done once for each operation, not for each message
        "Workspace.providers",
    }
)
"""Functions that are called meanwhile on behalf of something else, with all that they call."""


def is_apart(code: CodeType) -> bool:
    """Whether a function, with all that it calls, lies off the way."""
    name = code.co_qualname
    return (
        code.co_filename.startswith(
            tuple(f"{SOURCES}{each}" for each in ("sim/", "runtime/clock.py", "runtime/timers.py"))
        )
        or name in OTHERS
        or name.endswith("__missing__")
    )


def callers(frame: FrameType | None) -> Iterator[CodeType]:
    while frame is not None:
        yield frame.f_code
        frame = frame.f_back


class Walk:
    """The functions that are called from the odometry that crosses the line to the command that stops the wheels."""

    def __init__(self) -> None:
        self.passed: set[tuple[str, str]] = set()
        self._publish = MemoryPublisher.publish
        self._begun = False

    def publish(self, publisher: MemoryPublisher, message: Any) -> None:
        if not self._begun and publisher.topic.endswith("/odom") and message.pose.pose.position.x >= 1.0:
            self._begun = True
            sys.setprofile(self._note)
        self._publish(publisher, message)
        if publisher.topic.endswith("/cmd_vel") and message.linear.x == 0.0:
            sys.setprofile(None)

    def _note(self, frame: FrameType, event: str, _: object) -> None:
        code = frame.f_code
        if (
            event == "call"
            and code.co_filename.startswith(SOURCES)
            and not any(map(is_apart, callers(frame)))
        ):
            self.passed.add((code.co_filename.removeprefix(SOURCES), code.co_qualname))


def test_the_way_of_a_message_is_no_longer_than_the_page_says(tmp_path: Path, monkeypatch) -> None:
    page = JOURNEY.read_text(encoding="utf-8")
    told = COUNT.search(page.replace("\n", " "))
    program = re.search(r"```agentspeak line.asl\n(.*?)```", page, re.DOTALL)
    assert told is not None
    assert program is not None
    (tmp_path / "line.asl").write_text(program[1], encoding="utf-8")
    walk = Walk()

    def publish(publisher: MemoryPublisher, message: Any) -> None:
        walk.publish(publisher, message)

    monkeypatch.setattr(MemoryPublisher, "publish", publish)
    try:
        run_project(tmp_path / "line.asl")
    finally:
        sys.setprofile(None)

    functions, files = len(walk.passed), len({file for file, _ in walk.passed})
    ways = "\n".join(f"{file} {name}" for file, name in sorted(walk.passed))
    assert functions > 40, f"the walk was not seen:\n{ways}"
    assert functions <= int(told[1]), ways
    assert files <= int(told[2]), ways
