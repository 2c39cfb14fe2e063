"""The policies of sensors: what passes, when, and what does not."""

import math

import pytest

from jacaros.artifacts import Atom, Structure
from jacaros.robots.kit.options import WrongOption, read_arguments
from jacaros.robots.kit.reading import READING_OPTIONS, Reading
from jacaros.robots.streams import ReadingPolicy, Values
from jacaros.runtime.clock import VirtualClock, run


class Passed:
    """What a reading passed on, with the time."""

    def __init__(self, policy: ReadingPolicy) -> None:
        self.clock = VirtualClock()
        self.log: list[tuple[float, Values]] = []
        self.reading = Reading(policy, self.clock, self.note)

    def note(self, values: Values, cause: object) -> None:
        self.log.append((round(self.clock.elapsed, 6), values))

    def feed(self, *script: tuple[float, Values]) -> list[tuple[float, Values]]:
        """Take values at given times; then wait ten seconds."""

        async def main() -> None:
            for moment, values in script:
                await self.clock.sleep(moment - self.clock.elapsed)
                self.reading.take(values)
            await self.clock.sleep(10)

        run(main, self.clock)
        return self.log


def test_the_first_message_passes_and_equal_ones_are_dropped() -> None:
    """Defect 6: the original stored the first message and never published it."""
    passed = Passed(ReadingPolicy()).feed((0, (1.0, 2.0)), (1, (1.0, 2.0)), (2, (1.0, 2.5)), (3, (1, 2.5)))
    assert passed == [(0, (1.0, 2.0)), (2, (1.0, 2.5))]


def test_a_dead_band_drops_noise_but_not_slow_drift() -> None:
    """Defect 7: equality of doubles is defeated by noise."""
    policy = ReadingPolicy(dead_band=0.1)
    noisy = [(float(i), (1.0 + 0.04 * (-1) ** i,)) for i in range(5)]
    assert Passed(policy).feed(*noisy) == [(0, (1.04,))]
    drifting = [(float(i), (0.04 * i,)) for i in range(7)]
    assert [values for _, values in Passed(policy).feed(*drifting)] == [(0,), (0.12,), (0.24,)]


def test_each_field_can_have_its_own_dead_band() -> None:
    policy = ReadingPolicy(dead_band=(0.1, 5.0))
    passed = Passed(policy).feed((0, (0, 0, "a")), (1, (0, 4, "a")), (2, (0, 6, "a")), (3, (0, 6, "b")))
    assert [values for _, values in passed] == [(0, 0, "a"), (0, 6, "a"), (0, 6, "b")]


def test_a_rate_limit_counts_time_and_keeps_the_last_value_of_a_pause() -> None:
    """Defect 6: the original counted changed messages, and lost what came last."""
    script = [(0.05 * i, (i,)) for i in range(20)]
    passed = Passed(ReadingPolicy(rate=5)).feed(*script)
    assert passed == [(0, (0,)), (0.2, (3,)), (0.4, (7,)), (0.6, (11,)), (0.8, (15,)), (1.0, (19,))]


def test_after_a_pause_a_message_is_delivered_immediately_whatever_the_rate() -> None:
    passed = Passed(ReadingPolicy(rate=0.5)).feed((0, (1,)), (5, (2,)), (5.5, (3,)))
    assert passed == [(0, (1,)), (5, (2,)), (7, (3,))]


def test_a_value_that_returns_within_a_pause_is_not_delivered() -> None:
    passed = Passed(ReadingPolicy(rate=1)).feed((0, (1,)), (0.2, (2,)), (0.4, (1,)))
    assert passed == [(0, (1,))]


def test_on_demand_nothing_passes_but_the_newest_is_there() -> None:
    probe = Passed(ReadingPolicy(on_demand=True))
    assert probe.feed((0, (1,)), (1, (2,))) == []
    assert probe.reading.newest == (2,)


def test_not_a_number_equals_itself() -> None:
    nan = math.nan
    passed = Passed(ReadingPolicy(finite=False)).feed((0, (nan,)), (1, (nan,)), (2, (1.0,)), (3, (nan,)))
    assert [math.isnan(values[0]) for _, values in passed] == [True, False, True]  # type: ignore[arg-type]


def test_waiting_for_the_first_message_ends_with_it_or_with_the_time() -> None:
    probe = Passed(ReadingPolicy())

    async def main() -> None:
        with pytest.raises(TimeoutError):
            await probe.reading.first(2)
        assert probe.clock.elapsed == 2
        probe.clock.call_later(1, lambda: probe.reading.take((1,)))
        await probe.reading.first(2)
        assert probe.clock.elapsed == 3
        await probe.reading.first(2)

    run(main, probe.clock)


# Arguments of makeArtifact.


def test_arguments_are_a_robot_name_and_options_in_any_order() -> None:
    robot, options = read_arguments(
        ["robot_0", Structure("rate", (5,)), {"mode": "on_demand", "dead_band": [0.1, 0]}],
        READING_OPTIONS,
        "Art",
    )
    assert robot == "robot_0"
    assert options == {"rate": 5.0, "mode": "on_demand", "dead_band": (0.1, 0.0)}
    assert read_arguments([Structure("rate", (5,)), Atom("r")], READING_OPTIONS, "Art")[0] == "r"
    nested = [Structure("rate", (5,)), {"mode": "verbose"}]
    assert read_arguments(["r", nested], READING_OPTIONS, "Art")[1] == {"rate": 5.0, "mode": "verbose"}
    assert read_arguments([None], READING_OPTIONS, "Art")[0] == ""
    policy = ReadingPolicy.from_options(options)
    assert policy == ReadingPolicy(on_demand=True, rate=5.0, dead_band=(0.1, 0.0), latest_only=True)
    assert ReadingPolicy.from_options({"latest_only": False, "expire": 2.0}) == ReadingPolicy(expire=2.0)


@pytest.mark.parametrize(
    ("argument", "text"),
    [
        (
            Structure("rote", (5,)),
            "no option `rote`; its options: dead_band, expire, latest_only, mode, rate",
        ),
        (Structure("rate", (0,)), "rate(0): expected a number above zero"),
        (Structure("rate", ("fast",)), "expected a number"),
        (Structure("rate", (True,)), "expected a number"),
        (Structure("mode", ("loud",)), "expected verbose or on_demand"),
        (Structure("dead_band", (-1,)), "expected a number that is not negative"),
        (Structure("rate", (1, 2)), "expects a robot name and options"),
        (5, "expects a robot name and options"),
    ],
)
def test_a_wrong_argument_is_refused_with_what_is_known(argument: object, text: str) -> None:
    with pytest.raises(WrongOption) as refused:
        read_arguments(["robot_0", argument], READING_OPTIONS, "ArtOdometry")
    assert text in str(refused.value)
    assert "ArtOdometry" in str(refused.value)


def test_two_robot_names_are_refused() -> None:
    with pytest.raises(WrongOption, match="one robot name"):
        read_arguments(["a", "b"], READING_OPTIONS, "Art")
