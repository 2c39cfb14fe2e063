"""Messages on the sockets of ROS 1: cut apart on the loop, and sent without waiting for the other side."""

import asyncio
import contextlib
import socket
import time
from collections.abc import Callable, Iterator

import pytest

from jacaros.robots.ros.drivers.ros1.streams import CHUNK, Inlet, Outbox
from jacaros.runtime.clock import WallClock, run

PATIENCE = 20.0


@pytest.fixture
def pair() -> Iterator[tuple[socket.socket, socket.socket]]:
    """Two ends of a connection; the first one is given away."""
    ours, theirs = socket.socketpair()
    theirs.settimeout(PATIENCE)
    with contextlib.closing(ours), contextlib.closing(theirs):
        yield ours, theirs


def framed(data: bytes) -> bytes:
    return len(data).to_bytes(4, "little") + data


def received(theirs: socket.socket) -> bytes:
    """The next message at the other end."""
    return exactly(theirs, int.from_bytes(exactly(theirs, 4), "little"))


def exactly(theirs: socket.socket, size: int) -> bytes:
    found = b""
    while len(found) < size:
        more = theirs.recv(size - len(found))
        assert more, "the connection has ended"
        found += more
    return found


async def until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(PATIENCE):
        while not condition():  # noqa: ASYNC110 - what is awaited is what the loop reads
            await asyncio.sleep(0.001)


class Reading:
    """An inlet at one end of a connection, and what came."""

    def __init__(self, ours: socket.socket) -> None:
        self.got: list[bytes] = []
        self.rounds: list[int] = []
        self.bytes = 0
        self.ended = False
        self.inlet = Inlet(asyncio.get_running_loop(), ours, self._take, self._end)
        self.inlet.open()

    def _take(self, messages: list[bytes], size: int) -> None:
        self.got += messages
        self.rounds.append(len(messages))
        self.bytes += size

    def _end(self) -> None:
        self.ended = True


async def test_messages_are_cut_apart_wherever_the_chunks_end(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    ours, theirs = pair
    messages = [b"", b"a", b"two", bytes(range(256)) * 3, b"", b"last"]
    reading = Reading(ours)
    wire = b"".join(map(framed, messages))
    for k in range(len(wire)):
        theirs.send(wire[k : k + 1])
        await until(lambda wanted=k + 1: reading.bytes == wanted)
    assert reading.got == messages
    theirs.sendall(wire)
    await until(lambda: reading.bytes == 2 * len(wire))
    assert reading.got == messages * 2
    assert reading.rounds[-1] == len(messages)
    reading.inlet.close()


async def test_a_long_message_comes_whole(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    image = bytes(range(256)) * (40 * CHUNK // 256)
    reading = Reading(ours)
    sending = asyncio.get_running_loop().run_in_executor(
        None, theirs.sendall, framed(b"before") + framed(image) + framed(b"after")
    )
    await until(lambda: len(reading.got) == 3)
    await sending
    assert reading.got == [b"before", image, b"after"]
    reading.inlet.close()


async def test_what_piled_up_while_the_loop_was_busy_comes_together(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """Otherwise the newest cannot be distinguished from the oldest."""
    ours, theirs = pair
    piled_up = [b"%04d" % number * 256 for number in range(100)]
    theirs.sendall(b"".join(map(framed, piled_up)))
    reading = Reading(ours)
    await until(lambda: len(reading.got) == len(piled_up))
    assert reading.got == piled_up
    assert reading.rounds == [len(piled_up)]
    reading.inlet.close()


async def test_what_came_before_the_end_is_taken(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    reading = Reading(ours)
    theirs.sendall(framed(b"last word") + framed(b"half a message")[:9])
    theirs.close()
    await until(lambda: reading.ended)
    assert reading.got == [b"last word"]
    assert ours.fileno() == -1


async def test_a_receiver_may_close_its_inlet(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    got: list[bytes] = []

    def take(messages: list[bytes], size: int) -> None:
        got.extend(messages)
        inlet.close()
        inlet.close()

    inlet = Inlet(asyncio.get_running_loop(), ours, take, lambda: got.append(b"ended"))
    inlet.open()
    theirs.sendall(framed(b"one"))
    await until(lambda: bool(got))
    assert got == [b"one"]


def test_messages_leave_immediately_and_in_order(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    outbox = Outbox(ours, 10)
    for number in range(100):
        outbox.send(framed(b"%d" % number))
        assert not outbox.busy
    assert [received(theirs) for _ in range(100)] == [b"%d" % number for number in range(100)]
    assert outbox.sent_messages == 100
    outbox.close()


def test_a_slow_subscriber_blocks_no_publisher_and_gets_the_newest_messages(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    ours, theirs = pair
    outbox = Outbox(ours, 3)
    long = [bytes([number]) * 1_000_000 for number in range(50)]
    for message in long:
        outbox.send(framed(message))
    assert outbox.busy
    arrived = []
    while not arrived or arrived[-1] != long[-1]:
        arrived.append(received(theirs))
    # What the socket had taken, the one of which a part was gone, and of the others the newest.
    assert arrived == sorted(arrived)
    assert arrived[0] == long[0]
    assert arrived[-3:] == long[-3:]
    assert len(arrived) < len(long)
    while outbox.busy:  # the other side has the last one before the thread that sent it has counted it
        time.sleep(0)
    assert outbox.sent_messages == len(arrived)
    outbox.send(framed(b"and on"))
    assert received(theirs) == b"and on"
    outbox.close()


def test_nothing_is_dropped_where_any_number_may_wait(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    outbox = Outbox(ours, 0)
    long = [bytes([number]) * 500_000 for number in range(20)]
    for message in long:
        outbox.send(framed(message))
    assert [received(theirs) for _ in long] == long
    outbox.close()


def test_a_lost_subscriber_is_reported(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    outbox = Outbox(ours, 3)
    theirs.close()
    with pytest.raises(BrokenPipeError):
        outbox.send(framed(b"anybody there?"))
    outbox.close()


def test_closing_ends_what_waits(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = pair
    outbox = Outbox(ours, 3)
    while not outbox.busy:
        outbox.send(framed(bytes(1_000_000)))
    outbox.close()
    outbox.close()
    with pytest.raises(BrokenPipeError):
        outbox.send(framed(b"too late"))
    while theirs.recv(CHUNK):
        pass


def test_a_socket_closed_by_its_owner_ends_the_sending(pair: tuple[socket.socket, socket.socket]) -> None:
    ours, _ = pair
    outbox = Outbox(ours, 3)
    while not outbox.busy:
        outbox.send(framed(bytes(1_000_000)))
    ours.close()

    async def main() -> None:
        await until(lambda: not outbox.busy)

    run(main, WallClock())
    with pytest.raises(OSError, match="Bad file descriptor"):
        outbox.send(framed(b"too late"))
