"""Frames of a rosbridge server that are not operations, and frames for it that wait."""

import asyncio
import random
from types import SimpleNamespace

import cbor2
import pytest

pytest.importorskip("roslibpy")

from jacaros.ros.backends.rosbridge_link import BACKLOG, Link, _Protocol


def told_of(payload: bytes) -> list[str]:
    told: list[str] = []
    Link("ws://robot.example", lambda: None, lambda: None, lambda _: None, told.append).received(
        payload, binary=True
    )
    return told


@pytest.mark.parametrize(
    "payload",
    [
        b"",
        b"\xff" * 9,
        b"\x81" * 5000,
        b"\x5b" + b"\x7f" * 8,
        cbor2.dumps([1, 2]),
        cbor2.dumps(cbor2.CBORTag(30, [1, 0])),
        cbor2.dumps(cbor2.CBORTag(35, "(")),
        cbor2.dumps(cbor2.CBORTag(37, b"short")),
    ],
    ids=range(8),
)
def test_a_frame_of_junk_is_reported_and_ignored(payload: bytes) -> None:
    (told,) = told_of(payload)
    assert told.startswith("the rosbridge server sent a frame that is not an operation; it is ignored: ")
    assert len(told) < 600


def test_no_junk_ends_the_connection() -> None:
    chosen = random.Random(1)
    for _ in range(2000):
        told_of(chosen.randbytes(chosen.choice((1, 5, 60))))


def test_what_waits_for_the_thread_of_the_connection_counts_as_backlog() -> None:
    loop = asyncio.new_event_loop()
    protocol = _Protocol()
    protocol.factory = SimpleNamespace(manager=SimpleNamespace(loop=loop))
    protocol.transport = SimpleNamespace(get_write_buffer_size=lambda: 0)
    left: list[bytes] = []
    protocol.sendMessage = lambda payload, isBinary: left.append(payload)  # noqa: N803 (roslibpy's name)
    link = Link("ws://robot.example", lambda: None, lambda: None, lambda _: None, print)
    link._protocol = protocol
    message = {"op": "publish", "topic": "/picture", "msg": {"data": "x" * 100_000}}
    sent = sum(link.send(message, droppable=True) for _ in range(100))
    assert BACKLOG / 100_000 - 2 <= sent <= BACKLOG / 100_000 + 2
    loop.call_soon(loop.stop)
    loop.run_forever()
    loop.close()
    assert sum(map(len, left)) >= sent * 100_000
    assert protocol.backlog() == 0
