"""Members whose clocks differ: their offset is measured, and programs compute right ages from stamps."""

import asyncio
from collections.abc import Awaitable, Callable

import pytest
from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.channel import Clocks, Packet
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.runtime.clock import Clock, Timer, clock_of
from jacaros.runtime.mas.system import System

MINUTE = 60.0


class ShiftedClock(Clock):
    """A clock that is ahead of another one, which keeps the timers."""

    def __init__(self, clock: Clock, ahead: float) -> None:
        self._clock, self.ahead = clock, ahead
        self.virtual = clock.virtual

    @property
    def elapsed(self) -> float:  # type: ignore[override]
        return self._clock.elapsed

    def now(self) -> float:
        return self._clock.now() + self.ahead

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        return self._clock.call_later(delay, callback)

    def busy(self, cycles: int) -> None:
        self._clock.busy(cycles)

    def pause(self) -> None:
        self._clock.pause()

    def resume(self) -> None:
        self._clock.resume()


class LopsidedNetwork(SimulatedNetwork):
    """What the member `far` sends takes longer, by changing times; what is sent to it does not."""

    def carry(self, sender: MemberId, to: MemberId, datagram: bytes) -> None:
        self.spread = 0.3 if sender.name == "far" else 0.0
        super().carry(sender, to, datagram)


class Sensor(Artifact):
    """Publishes the time of its last sample, on the clock of its own system."""

    def init(self, clock: object) -> None:
        assert isinstance(clock, Clock)
        self.define_property("sample", clock.now())


class Pair:
    """Two members; the clock of `far` is a minute ahead."""

    def __init__(self, near: Mas, far: Mas, members: dict[str, Member], clock: ShiftedClock) -> None:
        self.near, self.far, self.members, self.clock = near, far, members, clock

    def offset(self) -> float:
        """Return the offset of the clock of `far` that `near` has measured."""
        return self.members["near"].peers["far"].channel.clocks.offset


def pair(test: Callable[[Pair], Awaitable[None]]) -> None:
    async def main() -> None:
        clock = clock_of(asyncio.get_running_loop())
        network = LopsidedNetwork(clock)
        members: dict[str, Member] = {}
        shifted = ShiftedClock(clock, MINUTE)

        def join(name: str) -> Mas:
            carrier = network.carrier()

            async def start(system: System) -> Callable[[], Awaitable[None]]:
                if name == "far":
                    system.clock = shifted
                return await joining(carrier, name, joined=lambda member: members.update({name: member}))(
                    system
                )

            return Mas(name=name, join=start)

        async with join("near") as near, join("far") as far:
            await test(Pair(near, far, members, shifted))

    jacaros.run(main(), clock="fast")


def test_an_offset_is_right_although_one_direction_is_slower() -> None:
    async def test(pair: Pair) -> None:
        await pair.near.sleep(5)
        assert pair.offset() == pytest.approx(MINUTE, abs=0.05)

    pair(test)


def test_a_program_computes_the_age_of_a_sample_of_another_member() -> None:
    async def test(pair: Pair) -> None:
        lab = pair.far.create_workspace("lab")
        pair.far.add_artifact_types(Sensor)
        await pair.far.make_artifact("sensor", Sensor, [pair.clock], workspace=lab)
        waited = 7.0
        await pair.near.sleep(waited)
        ann = pair.near.add_agent(
            "ann",
            """+sample(Stamp)[member(M)] : fleet_clock(M, Ahead) <- .nano_time(T); +age(T / 1.0e9 - (Stamp - Ahead)).
               +!look <- joinWorkspace("/main/lab"); lookupArtifact("sensor", Id); focus(Id).""",
            focus=["fleet"],
        )
        await ann.achieve("look").wait(timeout=9)
        age = (await ann.until("age(Seconds)", timeout=9))["Seconds"]
        assert age == pytest.approx(waited, abs=0.5)

    pair(test)


def test_a_program_hears_of_a_clock_that_is_set_and_of_nothing_smaller() -> None:
    async def test(pair: Pair) -> None:
        ann = pair.near.add_agent(
            "ann", "+fleet_clock(far, S) : heard(L) <- -+heard([S|L]). heard([]).", focus=["fleet"]
        )
        await pair.near.sleep(30)
        pair.clock.ahead = -5.0
        await pair.near.sleep(30)
        heard = ann.ask("heard(Offsets)")
        assert heard is not None
        assert heard["Offsets"] == [pytest.approx(-5, abs=0.1), pytest.approx(MINUTE, abs=0.1)]

    pair(test)


def packet(sent: float, echo: float, held: float = 0.0) -> Packet:
    return Packet(1, 1, 0, [], sent, echo, held)


def test_a_burst_of_late_packets_does_not_displace_a_good_measurement() -> None:
    clocks = Clocks()
    clocks.heard(packet(1060.001, 1000.0), 1000.002)
    for number in range(100):
        now = 1001.0 + number / 1000
        clocks.heard(packet(now + MINUTE - 0.4, now - 0.401), now)
    assert clocks.offset == pytest.approx(MINUTE, abs=0.002)


def test_an_inaccurate_first_measurement_is_not_reported() -> None:
    clocks = Clocks()
    clocks.heard(packet(1060.0, 1000.0), 1000.5)
    assert not clocks.has_moved()
    clocks.heard(packet(1061.001, 1001.0), 1001.002)
    assert clocks.has_moved()
    assert clocks.noted == pytest.approx(MINUTE, abs=0.002)
    assert not clocks.has_moved()
