"""Lines of the standard input arrive without holding up the loop."""

import asyncio
import os
import subprocess
import sys

import pytest

from jacaros.runtime.clock import Clock, VirtualClock, WallClock, run
from jacaros.runtime.input import LineInput


async def next_line(lines: LineInput) -> str | None:
    found: asyncio.Future[str | None] = asyncio.get_running_loop().create_future()
    lines.next_line(found.set_result)
    async with asyncio.timeout(
        5
    ):  # on the virtual clock this takes no time, but a line that is there comes first
        return await found


@pytest.mark.parametrize("clock", [WallClock(), VirtualClock()], ids=["wall", "virtual"])
def test_lines_of_a_pipe_come_one_by_one(clock: Clock) -> None:
    reader, writer = os.pipe()
    os.write(writer, b"kitchen\nh\xc3\xa4ll\r\nlast\xff")
    os.close(writer)

    async def main() -> list[str | None]:
        lines = LineInput(reader)
        return [await next_line(lines) for _ in range(4)]

    assert run(main, clock) == ["kitchen", "häll\r", "last\ufffd", None]
    os.close(reader)


IN_THE_BACKGROUND = """
import asyncio, os, pty, signal

def read():
    from jacaros.runtime.input import LineInput
    async def main():
        line = asyncio.get_running_loop().create_future()
        LineInput().next_line(line.set_result)
        print("line:", await line, flush=True)
    asyncio.run(main())

leader, terminal = pty.fork()
if leader:  # the terminal
    try:
        while piece := os.read(terminal, 1000):
            print(piece.decode(), end="")
    except OSError:  # its last process has ended
        pass
elif job := os.fork():  # the shell, whose process group is in the foreground
    _, status = os.waitpid(job, os.WUNTRACED)
    print("stopped" if os.WIFSTOPPED(status) else "ended", flush=True)
    os.kill(job, signal.SIGKILL) if os.WIFSTOPPED(status) else None
else:
    os.setpgid(0, 0)
    read()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no job control")
def test_a_job_in_the_background_is_not_stopped_by_its_terminal() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", IN_THE_BACKGROUND], capture_output=True, timeout=30, check=True, text=True
    )
    assert ran.stdout.split("\n") == ["line: None", "ended", ""]
