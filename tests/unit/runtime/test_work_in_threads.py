"""Work of `asyncio.to_thread` in the loops of runs."""

import asyncio
import threading
from collections.abc import Callable

import pytest

import jacaros


def test_work_fails_when_no_thread_is_left_and_does_not_hold_the_loop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ran: list[str] = []

    def refuse(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    async def main(work: Callable[[], None]) -> None:
        monkeypatch.setattr(threading.Thread, "start", refuse)
        with pytest.raises(RuntimeError, match="can't start new thread"):
            await asyncio.to_thread(work)
        await asyncio.sleep(0)
        assert ran == []

    jacaros.run(main(lambda: ran.append("here")))
