"""A recording on the page of live runs: its server, and ``jacaros view``."""

import asyncio
import re
import signal
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from live_client import PATIENCE, get, live_page

from jacaros.look.page.live.access import Access
from jacaros.look.page.live.live_view import LiveView
from jacaros.look.page.live.server import LiveServer, bound_socket
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording

WORLD = {"name": "lab", "robots": [{"name": "r1", "pose": [0, 0, 0], "radius": 0.2}]}


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    """A recording of a robot that drives, with more records than fit into one message."""
    path = tmp_path / "run.jsonl"
    recorder = Recorder(path)
    recorder.world(WORLD)
    recorder.event(0.0, "run", {"name": "patrol", "clock": "fast"})
    for index in range(3000):
        recorder.frame(index * 0.1, [RobotView("r1", index * 0.01, 0.0, 0.0, 90.0)])
        recorder.text(index * 0.1, "bob", f"at {index}")
    recorder.event(300.0, "ended", {"code": 0})
    recorder.close()
    return path


@asynccontextmanager
async def served(recorded: Path) -> AsyncIterator[LiveServer]:
    server = LiveServer(bound_socket(), Access(), LiveView.of_recording(Recording.read(recorded)))
    await server.start()
    assert (await get(server.address))[0] == 200
    yield server
    await server.close()


async def test_a_page_receives_the_whole_recording_in_time_order(recorded: Path) -> None:
    async with served(recorded) as server, live_page(server.address) as page:
        hello = {"kind": "hello", "version": 2, "title": "patrol", "live": False, "can": ["why"]}
        assert page.hello == hello
        await page.event("ended", code=0)
        assert [each["text"] for each in page.of("text")] == [f"at {index}" for index in range(3000)]
        frames = page.of("frame")
        assert len(frames) == 3000
        assert frames[-1]["robots"] == [[29.99, 0.0, 0.0, 90.0, 0, 0]]
        times = [each["t"] for each in page.records[1:] if each["kind"] != "story"]
        assert times == sorted(times)
        assert (await page.do("pause"))["ok"] is False
        assert isinstance(await page.done("why", question="nothing"), str)
        await page.refused("why", question="gibberish of no kind")


async def test_closing_the_server_waits_for_an_opened_browser(recorded: Path) -> None:
    async with served(recorded) as server:
        closing = asyncio.create_task(server.close(PATIENCE, visited=True))
        await asyncio.sleep(0)
        assert (await get(server.address))[0] == 200
        async with live_page(server.address) as page:
            await page.event("ended", code=0)
            await asyncio.wait_for(closing, PATIENCE)


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal of POSIX")
@pytest.mark.slow
def test_the_command_prints_the_address_serves_and_ends_with_ctrl_c(recorded: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "jacaros", "view", str(recorded)], stderr=subprocess.PIPE, text=True
    )
    assert process.stderr is not None
    try:
        found = re.fullmatch(r"view: (\S+:\d+/[\w-]+/)\n", process.stderr.readline())
        assert found is not None
        assert process.stderr.readline() == "press Ctrl+C to stop\n"
        status, _, content = asyncio.run(get(found[1]))
        assert status == 200
        assert b"live.js" in content
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 0
    finally:
        process.kill()
        process.stderr.close()
        process.wait()
