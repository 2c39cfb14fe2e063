"""Everything that one member sends to another one: in order, once, whatever the network loses, doubles or reorders.

Zenoh resends on each hop, but nothing tells a sender that a message has arrived, and what was under way when a link
breaks is lost. So payloads are numbered here. The receiver acknowledges the last one in order, and the sender keeps each
payload until then. All packets also carry clocks, from which delay and offset of the other clock are measured.

The numbers outlive a cut: what is still kept then is sent again, and not delivered again.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import msgspec

from jacaros.runtime.clock import Clock
from jacaros.runtime.timers import Timer

VERSION = 1
"""Version of everything on the wire."""
_MAGIC = b"JF"
_HEADER = _MAGIC + bytes([VERSION])
_WINDOW = 512 << 10
"""Bytes that are on their way at most; a larger payload travels alone."""
_DATAGRAM = 64 << 10
"""Bytes of payloads in one packet, except for a larger payload."""
_AHEAD = 4096
"""Payloads that are kept while an earlier one is missing."""
_PAUSE = 1e-4
"""Seconds after a packet until which payloads go together at the end of the turn of the loop; later, at once."""
_STREAM = 16
"""Unacknowledged payloads from which on others go together, as they do when a property changes all the time."""
_TOGETHER = 0.001
"""Seconds after which these go."""
_ACK_DELAY = 0.01
"""Seconds for which an acknowledgement waits for a packet to travel with."""
_ACK_EVERY = 32
"""Payloads after which it does not wait."""
_SOONEST, _LATEST = 0.05, 1.0
"""Bounds of the seconds after which a payload is sent again."""
BUSY = 64 << 10
"""Bytes under way beyond which the other side is behind."""
_LAG = 0.1
"""Seconds without an acknowledgement after which it is, too, unless the way there and back takes longer."""
_SAMPLES = 16
"""Measurements of the clocks, one a second, from which that with the shortest delay is taken."""
_PRECISION = 0.001
"""Seconds by which two right measurements of the clocks may differ, whatever their delays: clocks drift."""
NOTABLE = 0.1
"""Seconds by which the offset of a clock changes before programs notice."""
_FEW = 3
"""Measurements from which one with a long delay counts: the network has no shorter one."""


_Number = Annotated[int, msgspec.Meta(ge=0, le=1 << 62)]
"""Of a payload. Far more than anything counts to, and far from what can no longer be written."""
_Seconds = Annotated[float, msgspec.Meta(ge=-1e12, le=1e12)]
"""A time, neither infinite nor NaN: the clocks are computed from it."""


class Malformed(Exception):
    """Bytes that do not form a packet, or of another version. The text says what they are."""


class Packet(msgspec.Struct, array_like=True, forbid_unknown_fields=True):
    """What travels at a time.

    Attributes:
        base: number of the oldest payload that the sender still keeps. Earlier ones will never come.
        first: number of the first of the payloads.
        ack: number up to which everything has arrived from the other side.
        payloads: consecutive ones. An empty one was withdrawn.
        sent: clock of the sender, in seconds since the epoch.
        echo: ``sent`` of the newest packet from the other side; 0.0: none.
        held: seconds between the arrival of that packet and this one.
    """

    base: _Number
    first: _Number
    ack: _Number
    payloads: list[bytes]
    sent: _Seconds
    echo: _Seconds
    held: _Seconds


_read_packet = msgspec.msgpack.Decoder(Packet).decode
_write_packet = msgspec.msgpack.Encoder().encode


def read_packet(datagram: bytes) -> Packet:
    """Return the packet in a datagram.

    Raises:
        Malformed: it has none, or one of another version.
    """
    if datagram[:2] != _MAGIC or len(datagram) < 3:
        raise Malformed("bytes that are not a message of JaCaROS")
    if datagram[2] != VERSION:
        raise Malformed(f"version {datagram[2]} of the fleet's messages, this one has version {VERSION}")
    try:
        return _read_packet(memoryview(datagram)[3:])
    except msgspec.MsgspecError as error:
        raise Malformed(f"a damaged message ({error})") from None


@dataclass(slots=True)
class _Kept:
    """A payload that has not been acknowledged.

    Attributes:
        payload: empty if it was withdrawn.
        at: when it was sent, or is to be sent.
        on_lost: called if it is given up; None: it is withdrawn as soon as the other member is lost.
    """

    payload: bytes
    at: float
    on_lost: Callable[[], None] | None


class Clocks:
    """Delay, and offset of the other clock, measured from the times in packets, as NTP does.

    The measurement with the shortest delay of each second is kept: bursts of traffic do not displace it.

    Attributes:
        delay: seconds there and back, smoothed; None before the first measurement.
        least: the shortest delay so far.
        offset: seconds that the other clock is ahead of ours.
        noted: the offset when `has_moved` was last True; None before.
    """

    def __init__(self) -> None:
        self.delay: float | None = None
        self.least = self.offset = 0.0
        self.noted: float | None = None
        self._samples: deque[tuple[float, float, int]] = deque(maxlen=_SAMPLES)
        self._heard = self._heard_at = 0.0

    def heard(self, packet: Packet, now: float) -> None:
        """Measure, from a packet that has just arrived."""
        self._heard, self._heard_at = packet.sent, now
        if not packet.echo:
            return
        delay = max(0.0, now - packet.echo - packet.held)
        received = packet.sent - packet.held
        self.least = min(delay, self.least) if self._samples else delay
        self._note(delay, (received - packet.echo + packet.sent - now) / 2, int(now))
        self.delay = delay if self.delay is None else self.delay + (delay - self.delay) / 8

    def _note(self, delay: float, offset: float, second: int) -> None:
        samples = self._samples
        # An offset is right up to half of its delay. One that contradicts the others was measured after a clock was set.
        if samples and abs(offset - self.offset) > (delay + min(samples)[0]) / 2 + _PRECISION:
            samples.clear()
        if not samples or samples[-1][2] != second:
            samples.append((delay, offset, second))
        elif delay < samples[-1][0]:
            samples[-1] = (delay, offset, second)
        else:
            return
        self.offset = min(samples)[1]

    def has_moved(self) -> bool:
        """Return whether the offset is new, or has changed by more than a tenth of a second since the last True."""
        samples = self._samples
        if not samples or (len(samples) < _FEW and min(samples)[0] > NOTABLE):
            return False  # too inaccurate: both sides are busy when they begin
        if self.noted is not None and abs(self.offset - self.noted) <= NOTABLE:
            return False
        self.noted = self.offset
        return True

    def echo(self, now: float) -> tuple[float, float]:
        """Return what a packet that is sent now says of the newest one that was heard."""
        return self._heard, now - self._heard_at if self._heard else 0.0


class Channel:
    """Both directions between this member and another one.

    Args:
        clock: clock for time limits and measurements.
        transmit: sends a datagram, which may be lost.
        receive: called with each payload of the other side.

    Attributes:
        clocks: delay, and offset of the other clock.
        backlog: bytes that have not been acknowledged.
        when_drained: called whenever something has been acknowledged and the other side is not behind, or None.
    """

    def __init__(
        self, clock: Clock, transmit: Callable[[bytes], None], receive: Callable[[bytes], None]
    ) -> None:
        self.clocks = Clocks()
        self.backlog = 0
        self.when_drained: Callable[[], None] | None = None
        self._clock, self._transmit, self._receive = clock, transmit, receive
        self._kept: deque[_Kept] = deque()
        self._base = 1  # number of the first of those
        self._sent = 0  # how many of those have been sent, from the first
        self._flying = 0  # bytes of those
        self._expected = 1
        self._ahead: dict[int, bytes] = {}
        self._unacknowledged = 0
        self._flushing = False
        self._flushed_at = -_PAUSE
        self._tries = 0
        self._sent_at = 0.0  # when something was last sent, or acknowledged
        self._owed_at = 0.0
        self._ack_timer: Timer | None = None
        self._resend_timer: Timer | None = None
        self._open = True

    @property
    def is_behind(self) -> bool:
        """Whether what is sent now would wait on its way: the link or the other side is slow."""
        if not self._kept:
            return False
        patience = max(_LAG, 3 * self.clocks.least)
        return self.backlog > BUSY or self._clock.elapsed - self._kept[0].at > patience

    # ---- to the other side

    def send(self, payload: bytes, on_lost: Callable[[], None] | None = None) -> None:
        """Send a payload. See `_Kept` for *on_lost*."""
        now = self._clock.elapsed
        self._kept.append(_Kept(payload, now, on_lost))
        self.backlog += len(payload)
        if self._open and not self._flushing:
            if self._sent >= _STREAM:
                self._flushing = True
                self._clock.call_later(_TOGETHER, self._flush_rest)
            elif now - self._flushed_at < _PAUSE:
                self._flushing = True
                asyncio.get_running_loop().call_soon(self._flush_rest)
            else:
                self._flushed_at = now
                self._flush()

    def _flush_rest(self) -> None:
        self._flushing = False
        self._flushed_at = self._clock.elapsed
        self._flush()

    def _flush(self) -> None:
        while self._open and self._sent < len(self._kept):
            batch, size = self._next_batch()
            if not batch:
                return
            first = self._base + self._sent
            self._sent += len(batch)
            self._flying += size
            self._emit(first, batch)
            self._sent_at = self._clock.elapsed
            if self._resend_timer is None:
                self._resend_timer = self._clock.call_later(self._patience(), self._look)

    def _next_batch(self) -> tuple[list[bytes], int]:
        """Return the payloads of the next packet, as far as the window has room, and their size."""
        batch: list[bytes] = []
        size = 0
        for place in range(self._sent, len(self._kept)):
            payload = self._kept[place].payload
            full = size + len(payload) > _DATAGRAM or self._flying + size + len(payload) > _WINDOW
            if full and (batch or self._flying):
                break
            batch.append(payload)
            size += len(payload)
        return batch, size

    def _patience(self) -> float:
        expected = 3 * (self.clocks.delay or 0.1) + 2 * _ACK_DELAY
        return min(_LATEST, max(_SOONEST, expected) * 2.0 ** min(self._tries, 5))

    def _look(self) -> None:
        """Send again what has not been acknowledged in time."""
        self._resend_timer = None
        if not self._open or not self._sent:
            return
        left = self._sent_at + self._patience() - self._clock.elapsed
        if left <= 0:
            self._resend()
            left = self._patience()
        self._resend_timer = self._clock.call_later(left, self._look)

    def _resend(self) -> None:
        """Send the first packet again; what follows is sent as soon as that has been acknowledged."""
        self._tries += 1
        self._sent_at = self._clock.elapsed
        self._sent = self._flying = 0
        batch, size = self._next_batch()
        self._sent, self._flying = len(batch), size
        self._emit(self._base, batch)

    def _emit(self, first: int, payloads: list[bytes]) -> None:
        self._unacknowledged = 0
        now = self._clock.now()
        packet = Packet(self._base, first, self._expected - 1, payloads, now, *self.clocks.echo(now))
        self._transmit(_HEADER + _write_packet(packet))

    def ping(self) -> None:
        """Send a packet without payloads, which also acknowledges, even to a member that is lost."""
        self._emit(self._base + self._sent, [])

    # ---- from the other side

    def heard(self, packet: Packet) -> None:
        """Take in a packet."""
        self.clocks.heard(packet, self._clock.now())
        if not self._open:
            return
        self._acknowledged(packet.ack)
        self._skip_to(packet.base)
        before = self._expected
        if packet.first == before and not self._ahead:  # as nearly always
            self._deliver_all(packet.payloads)
        else:
            self._put_ahead(packet)
            self._deliver()
        if packet.payloads:
            self._owe(self._expected - before)

    def _put_ahead(self, packet: Packet) -> None:
        """Keep what came out of order, as far as there is room: the rest comes again."""
        room = 2 * _WINDOW - sum(map(len, self._ahead.values()))
        for number, payload in enumerate(packet.payloads, packet.first):
            is_next = number == self._expected
            if is_next or (self._expected < number < self._expected + _AHEAD and len(payload) <= room):
                self._ahead[number] = payload
                room -= len(payload)

    def _skip_to(self, base: int) -> None:
        """Forget numbers that the other side has given up, even those that came out of order."""
        if base > self._expected:
            self._expected = base
            self._ahead = {number: payload for number, payload in self._ahead.items() if number >= base}
            self._deliver()

    def _deliver_all(self, payloads: list[bytes]) -> None:
        for payload in payloads:
            self._expected += 1
            if payload:
                self._receive(payload)

    def _deliver(self) -> None:
        while (payload := self._ahead.pop(self._expected, None)) is not None:
            self._expected += 1
            if payload:
                self._receive(payload)

    def _owe(self, arrived: int) -> None:
        """Acknowledge soon; immediately if a payload is missing or came again, or there were many."""
        self._unacknowledged += arrived
        if not arrived or self._ahead or self._unacknowledged >= _ACK_EVERY:
            self.ping()
            return
        if self._unacknowledged == arrived:
            self._owed_at = self._clock.elapsed
        if self._ack_timer is None:
            self._ack_timer = self._clock.call_later(_ACK_DELAY, self._acknowledge)

    def _acknowledge(self) -> None:
        """Acknowledge what has waited long enough."""
        self._ack_timer = None
        if not self._unacknowledged:
            return
        left = self._owed_at + _ACK_DELAY - self._clock.elapsed
        if left > 1e-4:
            self._ack_timer = self._clock.call_later(left, self._acknowledge)
        else:
            self.ping()

    def _acknowledged(self, number: int) -> None:
        count = min(number - self._base + 1, len(self._kept))
        if count <= 0:
            return
        for place in range(count):
            size = len(self._kept.popleft().payload)
            self.backlog -= size
            if place < self._sent:
                self._flying -= size
        self._base += count
        self._sent = max(0, self._sent - count)
        self._tries = 0
        self._sent_at = self._clock.elapsed
        self._flush()
        if self.when_drained is not None and not self.is_behind:
            self.when_drained()

    # ---- losses

    def lose(self) -> None:
        """The other member does not answer: stop sending, and withdraw what need not be kept for its return."""
        self._stop()
        if all(each.on_lost is None for each in self._kept):
            self._base += len(self._kept)
            self._kept.clear()
        self._sent = self._tries = 0
        self.withdraw()

    def withdraw(self) -> None:
        """Withdraw what need not be kept, and has not arrived as far as is known."""
        for each in self._kept:
            if each.on_lost is None:
                each.payload = b""
        sizes = [len(each.payload) for each in self._kept]
        self.backlog, self._flying = sum(sizes), sum(sizes[: self._sent])

    def find(self) -> None:
        """The other member answers again: send everything that is kept."""
        self._open = True
        self._flush()

    def give_up(self) -> None:
        """Give up everything that is kept: the other member will not return."""
        self._stop()
        kept, self._kept = self._kept, deque()
        self._base += len(kept)
        self.backlog = self._sent = self._flying = 0
        for each in kept:
            if each.on_lost is not None:
                each.on_lost()

    def _stop(self) -> None:
        self._open = False
        for timer in (self._ack_timer, self._resend_timer):
            if timer is not None:
                timer.cancel()
        self._ack_timer = self._resend_timer = None
