"""A channel delivers in order and once, over a link that loses, doubles, reorders and breaks."""

import asyncio
from collections.abc import Callable
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import jacaros
from jacaros.fleet import channel
from jacaros.fleet.channel import Channel, Malformed, read_packet
from jacaros.runtime.clock import Clock, clock_of


class ShiftedClock:
    """The clock of another computer, which is ahead."""

    def __init__(self, clock: Clock, ahead: float) -> None:
        self._clock, self._ahead = clock, ahead
        self.call_later = clock.call_later

    @property
    def elapsed(self) -> float:
        return self._clock.elapsed

    def now(self) -> float:
        return self._clock.now() + self._ahead


class Link:
    """Two channels and what is between them.

    Attributes:
        arrived: payloads that each of the two has received.
        datagrams: what was transmitted, in both directions.
    """

    def __init__(self, seed: int = 0, ahead: float = 0.0) -> None:
        clock = self.clock = clock_of(asyncio.get_running_loop())
        self.random = Random(seed)
        self.delay, self.spread, self.loss, self.doubling = 0.01, 0.0, 0.0, 0.0
        self.arrived: tuple[list[bytes], list[bytes]] = [], []
        self.datagrams: list[bytes] = []
        self.a = Channel(clock, self._to(lambda: self.b), self.arrived[0].append)
        other = ShiftedClock(clock, ahead)
        self.b = Channel(other, self._to(lambda: self.a), self.arrived[1].append)  # type: ignore[arg-type]

    def _to(self, receiver: Callable[[], Channel]) -> Callable[[bytes], None]:
        def transmit(datagram: bytes) -> None:
            self.datagrams.append(datagram)
            for _ in range(1 + (self.random.random() < self.doubling)):
                if self.random.random() >= self.loss:
                    delay = self.delay + self.random.random() * self.spread
                    self.clock.call_later(delay, lambda: receiver().heard(read_packet(datagram)))

        return transmit

    def bytes_on_their_way(self) -> list[int]:
        """Return how large the payloads of each datagram were together."""
        return [sum(map(len, read_packet(each).payloads)) for each in self.datagrams]


STEPS = st.lists(
    st.tuples(
        st.sampled_from(["keep", "say", "lose a", "lose b", "find a", "find b", "withdraw", "wait"]),
        st.integers(0, 9),
    ),
    min_size=5,
    max_size=40,
)


@given(STEPS, st.integers(0, 2**16))
def test_what_is_kept_arrives_once_and_in_order(steps: list[tuple[str, int]], seed: int) -> None:
    async def main() -> None:
        link = Link(seed)
        link.loss, link.doubling, link.spread = 0.3, 0.3, 0.05
        kept: list[bytes] = []
        said: list[bytes] = []
        for what, number in steps:
            if what in ("keep", "say"):
                payload = b"%s %d" % (what.encode(), len(said))
                said.append(payload)
                if what == "keep":
                    kept.append(payload)
                    link.a.send(payload, lambda: None)
                else:
                    link.a.send(payload)
            elif what == "withdraw":
                link.a.withdraw()
            elif what == "wait":
                await link.clock.sleep(number / 10)
            else:
                end = link.a if what[-1] == "a" else link.b
                end.lose() if what.startswith("lose") else end.find()
        link.loss = 0.0
        link.a.find()
        link.b.find()
        await link.clock.sleep(10)
        arrived = link.arrived[1]
        assert [each for each in arrived if each.startswith(b"keep")] == kept
        assert [said.index(each) for each in arrived] == sorted({said.index(each) for each in arrived})
        assert link.a.backlog == 0

    jacaros.run(main(), clock="fast")


def test_what_is_withdrawn_does_not_arrive_and_holds_nothing_up() -> None:
    async def main() -> None:
        link = Link()
        link.loss = 1.0
        link.a.send(b"operate")
        link.a.send(b"tell", lambda: None)
        await link.clock.sleep(1)
        link.a.withdraw()
        assert link.a.backlog == len(b"tell")
        link.a.send(b"picture")
        link.loss = 0.0
        await link.clock.sleep(5)
        assert link.arrived[1] == [b"tell", b"picture"]
        assert link.a.backlog == 0

    jacaros.run(main(), clock="fast")


def test_what_is_given_up_is_reported_and_never_arrives() -> None:
    async def main() -> None:
        link = Link()
        link.loss = 1.0
        lost: list[int] = []
        for number in range(3):
            link.a.send(b"x", lambda number=number: lost.append(number))  # type: ignore[misc]
        await link.clock.sleep(1)
        link.a.lose()
        link.a.give_up()
        assert lost == [0, 1, 2]
        link.loss = 0.0
        link.a.find()
        link.a.send(b"y")
        await link.clock.sleep(5)
        assert link.arrived[1] == [b"y"]

    jacaros.run(main(), clock="fast")


def test_bytes_under_way_are_bounded_and_a_large_payload_goes_alone() -> None:
    async def main() -> None:
        link = Link()
        link.loss = 1.0
        for _ in range(2000):
            link.a.send(b"x" * 1000)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert 0 < sum(link.bytes_on_their_way()) <= channel._WINDOW
        assert max(link.bytes_on_their_way()) <= channel._DATAGRAM
        link.loss = 0.0
        await link.clock.sleep(30)
        link.datagrams.clear()
        link.a.send(b"y" * 2 * channel._WINDOW)
        link.a.send(b"z")
        await link.clock.sleep(5)
        assert link.arrived[1][-2:] == [b"y" * 2 * channel._WINDOW, b"z"]
        assert len(link.arrived[1]) == 2002

    jacaros.run(main(), clock="fast")


@pytest.mark.parametrize("ahead", [-60.0, 0.0, 60.0])
def test_clocks_of_both_sides_are_compared(ahead: float) -> None:
    async def main() -> None:
        link = Link(ahead=ahead)
        link.spread = 0.02
        for _ in range(40):
            link.a.send(b"x")
            await link.clock.sleep(0.2)
        assert link.a.clocks.offset == pytest.approx(ahead, abs=0.02)
        assert link.b.clocks.offset == pytest.approx(-ahead, abs=0.02)
        assert link.a.clocks.delay == pytest.approx(0.04, abs=0.02)

    jacaros.run(main(), clock="fast")


@pytest.mark.parametrize(
    ("datagram", "what"),
    [
        (b"", "bytes that are not a message of JaCaROS"),
        (b"GET / HTTP/1.1", "bytes that are not a message of JaCaROS"),
        (b"JF\x07\x90", "version 7 of the fleet's messages, this one has version 1"),
        (b"JF\x01", "a damaged message"),
        (b"JF\x01\x90", "a damaged message"),
    ],
)
def test_what_is_not_a_packet_is_named(datagram: bytes, what: str) -> None:
    with pytest.raises(Malformed, match=what):
        read_packet(datagram)
