"""What matters first on the page: the headline, the story of a replay, loud lines of the log, and a run that is gone."""

import asyncio
import sys
from pathlib import Path
from typing import Any

import pytest
from devtools import Page, chromium, needs_chromium, replayed

from jacaros.look.page.page import write_replay
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording

WORLD = {"name": "lab", "bounds": [-1, -1, 1, 1], "robots": [{"name": "r1", "radius": 0.2}]}
EMPTY = "action_failed, action /go was aborted with code 105: the battery is empty (watch.asl:7)"
LOST = f"[watch] warning: the goal !patrol(2) failed and has no plan for its failure: {EMPTY}\n  step: go(2)"


def stack(goal: str, waits: str, step: str = "") -> dict[str, Any]:
    steps = [{"goal": goal, "plan": 1, "file": "watch.asl", "line": 7, "step": step}]
    return {"agent": "watch", "id": 1, "state": "waits", "stack": steps, "waits": waits, "since": 0.0}


def failing() -> Recording:
    """A robot drives to a corner, recovers once from a failure, and then its battery is empty."""
    recorder = Recorder()
    recorder.world(WORLD)
    for t in range(10):
        recorder.frame(float(t), [RobotView("r1", 0.1 * t, 0.0, 0.0, max(0.0, 60.0 - 10 * t))])

    def goal(t: float, goal: str, state: str, number: int, **more: Any) -> None:
        data = {"agent": "watch", "goal": goal, "state": state, "id": number, "intention": 1, **more}
        recorder.event(t, "goal", data)

    recorder.event(0.0, "agent", {"agent": "watch", "state": "began"})
    recorder.event(0.0, "belief", {"agent": "watch", "op": "+", "belief": "corner(2,2.123456789012,0,90)"})
    recorder.event(0.0, "belief", {"agent": "watch", "op": "+", "belief": 'focusing(cobj_3,nav,"nav",main)'})
    recorder.event(0.0, "belief", {"agent": "watch", "op": "+", "belief": 'connected("/scan")'})
    goal(0.0, "!patrol(2)", "pursued", 1)
    recorder.event(0.1, "intention", stack("!patrol(2)", "the action driveTo(2.123456789012,0)"))
    goal(2.0, "!look", "pursued", 2)
    goal(2.0, "!look", "failed", 2, why="ia_failed, blind (watch.asl:9)")
    goal(2.0, "!look", "recovered", 2)
    recorder.text(3.0, "watch", "corner 1")
    recorder.event(6.0, "battery_empty", {"robot": "r1", "level": 0})
    recorder.event(6.0, "log", {"level": "warning", "text": LOST})
    goal(6.0, "!patrol(2)", "failed", 1, why=EMPTY)
    recorder.event(6.1, "intention", {"agent": "watch", "id": 1, "state": "over"})
    recorder.event(9.0, "ended", {"code": 0})
    recorder.close()
    return recorder.recording


@needs_chromium
async def test_the_headline_says_what_the_robot_does_and_then_what_is_wrong() -> None:
    async with replayed(failing(), 1.0) as page:
        await page.wait_for("document.querySelector('#headline p.busy')")
        assert "watch: driving to corner 2 (!patrol(2))" in await page.text("#headline")
        await page.evaluate(
            "document.querySelector('#scrub').value = 8; document.querySelector('#scrub').dispatchEvent(new Event('input'))"
        )
        await page.wait_for("document.querySelector('#headline p.error')")
        assert "watch: no goal since 0:06.0, !patrol(2) failed: the battery is empty" in await page.text(
            "#headline"
        )
        assert "+1 more" in await page.text("#headline"), "the battery of the robot"
        assert await page.evaluate("document.querySelector('.robot').classList.contains('flat')")
        await page.click("#headline .more")
        await page.wait_for("document.querySelectorAll('#headline p').length === 2")
        assert (await page.texts("#headline p"))[1].endswith("r1: the battery is empty")
        await page.click("#headline .what")
        await page.wait_for("document.querySelector('#now').textContent === '0:06.0'")


@needs_chromium
async def test_a_replay_opens_with_its_story_at_the_first_failure(tmp_path: Path) -> None:
    write_replay(failing(), tmp_path / "run.html")
    async with chromium() as page:
        await page.open((tmp_path / "run.html").as_uri())
        await page.wait_for("document.querySelector('#now')?.textContent === '0:06.0'")
        lines = await page.texts("#story .moment")
        assert "r1: the battery is empty" in lines[2]
        assert "had no goal" in lines[-1]
        await page.click("#story li:last-child .moment")
        await page.wait_for("document.querySelector('#now').textContent === '0:09.0'")
        assert await page.evaluate("document.querySelector('#story').checkVisibility()"), (
            "the story stays open"
        )
        assert page.errors == []


@needs_chromium
async def test_failures_are_louder_than_prints_and_handled_ones_have_hollow_marks() -> None:
    async with replayed(failing(), 8.0) as page:
        await page.wait_for("document.querySelectorAll('.log li.failure').length === 2")
        assert "watch the goal !patrol(2) failed" in (await page.texts(".log li.failure"))[1]
        assert await page.evaluate(
            "[...document.querySelectorAll('.marks .mark')].map((each) => each.className.split(' ')[1])"
        ) == [
            "handled",
            "failure",
        ]


@needs_chromium
async def test_machinery_is_one_row_after_the_beliefs_and_long_numbers_are_rounded() -> None:
    async with replayed(failing(), 5.0) as page:
        await page.click("#tab-agents")
        await page.wait_for("document.querySelector('.machinery')")
        assert await page.text(".machinery summary") == "2 about the environment: connected, focusing"
        assert await page.texts(".beliefs .belief code") == ["corner(2,2.1235,0,90)"]
        title = await page.evaluate("document.querySelector('.beliefs .belief').title")
        assert title == "corner(2,2.123456789012,0,90)"


@needs_chromium
@pytest.mark.skipif(sys.platform == "win32", reason="reads the address from a pipe")
async def test_a_killed_run_does_not_look_live(tmp_path: Path) -> None:
    program = tmp_path / "bob.asl"
    program.write_text("!go. +!go <- .wait(100); !go.")
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "jacaros", "run", str(program), "--view", stderr=asyncio.subprocess.PIPE
    )
    assert process.stderr is not None
    try:
        async with chromium() as page:
            address = await _address(process.stderr)
            await page.open(address)
            await page.wait_for("document.querySelector('#headline')?.innerText.includes('bob')")
            assert await page.text(".onair") == "Live"
            process.kill()
            await _shows_loss(page)
    finally:
        if process.returncode is None:
            process.kill()
        await process.wait()


async def _address(output: asyncio.StreamReader) -> str:
    async for line in output:
        if line.startswith(b"view: "):
            return line.decode().removeprefix("view: ").strip()
    raise AssertionError("the run printed no address")


async def _shows_loss(page: Page) -> None:
    await page.wait_for("document.body.classList.contains('stale')")
    await page.wait_for("document.querySelector('#headline').innerText.includes('last message')")
    assert await page.text(".onair") == "Connection lost"
    assert not await page.evaluate("document.querySelector('.live').checkVisibility()")


@needs_chromium
async def test_earlier_rounds_of_a_loop_are_one_line_of_why() -> None:
    recorder = Recorder()
    recorder.world(WORLD)
    plan = {"id": 1, "trigger": "+!go(N)", "file": "a.asl", "line": 3, "end": 4}
    recorder.event(0.0, "program", {"agent": "watch", "plans": [plan], "rules": []})
    for number in range(1, 26):
        event = {
            "id": number,
            "parent": number - 1,
            "agent": "watch",
            "trigger": f"+!go({number})",
            "intention": 1,
        }
        recorder.event(float(number), "deliberation", {**event, "chosen": 1, "options": [], "untried": []})
    recorder.close()
    async with replayed(recorder.recording, 25.0) as page:
        await page.click("#tab-causes")
        await page.click(".why .effects li:first-child .link")
        await page.wait_for("document.querySelector('.why .rounds')")
        assert (await page.text(".why .rounds")).split("\n")[-1] == "23 earlier rounds like this"
        assert len(await page.texts(".why .chain li")) == 2, "the newest round, and the number of the others"
