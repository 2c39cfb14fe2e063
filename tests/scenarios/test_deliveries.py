"""A robot that delivers for callers by several doors, judged by what truly happened."""

import asyncio
from collections.abc import Awaitable, Callable
from functools import cache
from typing import Any

from examples_lab import EXAMPLES, checker

from jacaros.robots.world import GroundTruth
from jacaros.runtime.mas.system import System
from jacaros.serving.callers import Caller
from jacaros.serving.service import Session, service_of
from jacaros.testing import run_project

PROJECT = EXAMPLES / "13_deliveries" / "deliveries.jcm"
module = checker("13_deliveries")
Work = Callable[[System, Callable[[str, str], Session]], Awaitable[None]]


def served(work: Work) -> GroundTruth:
    """Run the example until *work* has ended; it opens sessions by door and name."""
    tasks: list[asyncio.Task[None]] = []

    def started(system: System) -> None:
        def session(door: str, name: str) -> Session:
            return service_of(system).open(Caller(name, door, frozenset({"user"})))

        async def main() -> None:
            try:
                await work(system, session)
            finally:
                system.end(0)

        tasks.append(asyncio.get_running_loop().create_task(main()))

    result = run_project(PROJECT, when_started=started, seconds=2000.0)
    tasks[0].result()
    assert result.exit_code == 0
    truth: GroundTruth = result.ground_truth
    return truth


@cache
def of_three_callers() -> tuple[GroundTruth, list[dict[str, Any]], str]:
    """Return the truth of a run, the goals of three callers, and why one of them was refused."""
    goals: list[dict[str, Any]] = []
    told: list[str] = []

    async def work(system: System, session: Callable[[str, str], Session]) -> None:
        began = system.clock.now()
        callers = [session("ros", "orders"), session("http", "form"), session("mcp", "model")]
        await system.clock.sleep(3)
        rooms = ("kitchen", "living_room", "bathroom")

        async def order(number: int) -> None:
            for turn in range(6):
                given = {"parcel": f"{number}.{turn}", "room": rooms[(number + turn) % 3]}
                goal = callers[number].achieve("robot", "deliver", given)
                await goal.wait()
                data = goal.data()
                goals.append({**data, "began": data["began"] - began, "ended": data["ended"] - began})
                await system.clock.sleep(20)

        await asyncio.gather(*map(order, range(3)))
        refused = next(each for each in goals if each["state"] == "refused")
        told.append((await callers[0].why(f"why !{refused['written']}")).text())
        await system.clock.sleep(60)  # it leaves the dock with a full battery

    truth = served(work)
    return truth, goals, told[0]


def test_each_delivery_is_fetched_and_brought_and_the_battery_lasts() -> None:
    truth, goals, _ = of_three_callers()
    done = module.deliveries(goals, 0.0)
    verdict = module.check(truth, done)
    print(*verdict.lines(), sep="\n")
    assert verdict.complaints == []
    assert verdict.measured["recharges"] >= 1
    assert {each["caller"] for each in goals if each["state"] == "achieved"} == {
        "ros:orders",
        "http:form",
        "mcp:model",
    }
    assert all(8 <= each["results"]["percent"] <= 20 for each in goals if each["state"] == "achieved")


def test_what_the_battery_does_not_allow_is_refused_with_the_reason_and_explained() -> None:
    _, goals, why = of_three_callers()
    refused = [each for each in goals if each["state"] != "achieved"]
    assert refused
    for each in refused:
        assert each["state"] == "refused"
        assert each["reasons"][0].startswith("refused(battery(")
    assert f"asked by {refused[0]['caller']}" in why
    assert "Left - Percent < Least" in why


def test_a_room_that_a_caller_has_closed_is_refused() -> None:
    goals: list[dict[str, Any]] = []

    async def work(system: System, session: Callable[[str, str], Session]) -> None:
        web, ros = session("http", "form"), session("ros", "orders")
        await system.clock.sleep(3)
        web.tell("robot", "closed", ["kitchen"])
        await system.clock.sleep(1)
        goal = ros.achieve("robot", "deliver", ["mail", "kitchen"])
        await goal.wait()
        goals.append(goal.data())
        web.tell("robot", "closed", ["kitchen"], untell=True)
        await system.clock.sleep(1)
        goal = ros.achieve("robot", "deliver", ["mail", "kitchen"])
        await goal.wait()
        goals.append(goal.data())

    served(work)
    assert [each["state"] for each in goals] == ["refused", "achieved"]
    assert goals[0]["reasons"][0] == 'refused(closed(kitchen,"http:form"))'


def test_a_delivery_that_never_took_place_is_noticed() -> None:
    truth, goals, _ = of_three_callers()
    first = module.deliveries(goals, 0.0)[0]
    elsewhere = next(room for room in module.PLACES if room not in (first.room, "hallway"))
    assert not module.check(truth, [first._replace(room=elsewhere)]).passed
    assert not module.check(truth, [first._replace(begin=first.end - 1.0)]).passed
