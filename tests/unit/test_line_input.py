"""Lines of the standard input arrive without holding up the loop."""

import asyncio
import os

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
