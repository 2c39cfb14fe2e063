"""Frames of a rosbridge server that are not operations."""

import random

import cbor2
import pytest

pytest.importorskip("roslibpy")

from jacaros.ros.backends.rosbridge_link import Link


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
