"""The end of a run shown on a live page: pages receive all of it, and it does not take long."""

import asyncio
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from live_client import PATIENCE, live_page, socket_address
from websockets.asyncio.client import connect

PROGRAM = "!start. +!start <- .wait(found(_)); .print(bye); .stopMAS(0, 3)."


@pytest.fixture
def run(tmp_path: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A program that waits for a belief, then ends with code 3: its process, and the address of its page."""
    (tmp_path / "waiter.asl").write_text(PROGRAM)
    command = [sys.executable, "-m", "jacaros", "run", str(tmp_path / "waiter.asl"), "--view"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    assert process.stderr is not None
    found = re.fullmatch(r"view: (\S+)\n", process.stderr.readline())
    assert found is not None
    yield process, found[1]
    process.kill()
    process.communicate()


@pytest.mark.slow
async def test_a_page_receives_the_end_of_the_run(run: tuple[subprocess.Popen[str], str]) -> None:
    process, address = run
    async with live_page(address) as page:
        await page.done("console", agent="waiter", text="+found(key)")
        await page.event("ended", code=3)
        assert "bye" in [each["text"] for each in page.of("text")]
    assert await asyncio.to_thread(process.wait, PATIENCE) == 3


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal of POSIX")
@pytest.mark.slow
async def test_blocked_pages_do_not_delay_the_end(run: tuple[subprocess.Popen[str], str]) -> None:
    process, address = run
    socket = await connect(socket_address(address), max_queue=1)
    await socket.recv()
    socket.transport.pause_reading()
    began = time.monotonic()
    process.send_signal(signal.SIGINT)
    await asyncio.to_thread(process.wait, PATIENCE)
    socket.transport.abort()
    assert time.monotonic() - began < PATIENCE / 2
    assert process.returncode == 130
