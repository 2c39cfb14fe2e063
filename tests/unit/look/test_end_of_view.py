"""The end of a run shown on a live page: pages receive all of it, and it does not take long."""

import asyncio
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from live_client import PATIENCE, live_page
from websockets.asyncio.client import connect

PROGRAM = "!start. +!start <- .wait(found(_)); .print(bye); .stopMAS(0, 3)."


def started(program: Path) -> tuple[subprocess.Popen[str], str]:
    """Start a run with a page; its process and the address of the page."""
    command = [sys.executable, "-m", "jacaros", "run", str(program), "--view"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    assert process.stderr is not None
    found = re.fullmatch(r"view: (\S+)\n", process.stderr.readline())
    assert found is not None
    return process, found[1]


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program that waits for a belief, then ends with code 3."""
    path = tmp_path / "waiter.asl"
    path.write_text(PROGRAM)
    return path


@pytest.mark.slow
def test_a_page_receives_the_end_of_the_run(program: Path) -> None:
    process, address = started(program)

    async def main() -> None:
        async with live_page(address) as page:
            await page.do("belief", agent="waiter", op="+", text="found(key)")
            await page.event("ended", code=3)
            assert any(each["kind"] == "text" and each["text"] == "bye" for each in page.records)

    try:
        asyncio.run(main())
        assert process.wait(PATIENCE) == 3
    finally:
        process.kill()
        process.communicate()


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal of POSIX")
@pytest.mark.slow
def test_blocked_pages_do_not_delay_the_end(program: Path) -> None:
    process, address = started(program)

    async def main() -> float:
        socket = await connect(f"{address.replace('http', 'ws', 1)}live", max_queue=1)
        await socket.recv()
        socket.transport.pause_reading()
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        await asyncio.to_thread(process.wait, PATIENCE)
        socket.transport.abort()
        return time.monotonic() - began

    try:
        assert asyncio.run(main()) < PATIENCE / 2
        assert process.returncode == 130
    finally:
        process.kill()
        process.communicate()
