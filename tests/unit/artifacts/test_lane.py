"""The lane: one motion at a time, in the order of the requests, and no wake-up is lost."""

from jacaros.artifacts.robots.lane import Lane, Ticket, lane_of
from jacaros.clock import VirtualClock, run
from jacaros.ros.open import open_backend


def ticket() -> Ticket:
    return Ticket(lambda: None)


def test_the_lane_goes_from_one_to_the_next_in_the_order_of_asking() -> None:
    lane = Lane()
    a, b, c = ticket(), ticket(), ticket()
    assert lane.enter(a)
    assert lane.enter(a)
    assert not lane.enter(b)
    assert not lane.enter(c)
    lane.leave(b)
    lane.leave(a)
    assert lane.holds(c)
    lane.leave(a)
    assert lane.holds(c)
    lane.leave(c)
    assert lane.enter(b)


def test_a_wake_up_before_the_wait_is_not_lost() -> None:
    clock = VirtualClock()

    async def main() -> None:
        lane = Lane()
        first, second = ticket(), ticket()
        lane.enter(first)
        assert not lane.enter(second)
        lane.leave(first)
        await second.wait(clock, None)
        assert lane.holds(second)
        await second.wait(clock, 1.0)
        assert clock.elapsed == 1

    run(main, clock)


def test_abort_stops_and_wakes_whoever_drives_or_waits() -> None:
    stopped = []
    lane = Lane()
    tickets = [Ticket(lambda number=number: stopped.append(number)) for number in range(3)]  # type: ignore[misc]
    for each in tickets[:2]:
        lane.enter(each)
    lane.abort()
    assert stopped == [0, 1]
    assert [each.aborted for each in tickets] == [True, True, False]


def test_a_robot_of_a_backend_has_one_lane() -> None:
    clock = VirtualClock()

    async def main() -> None:
        one, other = (open_backend("memory", clock, name) for name in ("one", "other"))
        assert lane_of(one, "/r") is lane_of(one, "/r")
        assert lane_of(one, "/r") is not lane_of(one, "")
        assert lane_of(one, "/r") is not lane_of(other, "/r")

    run(main, clock)
