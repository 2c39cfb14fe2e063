"""The artifact `fleet`: agents perceive who is in their fleet."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.fleet.joining import joining
from jacaros.runtime.clock import clock_of
from jacaros.runtime.mas.launch import in_fleet, load_deployment

WATCH = """
heard([]).
+fleet_member(N, S) : heard(L) <- -+heard([n(N, S)|L]).
-fleet_member(N, S) : heard(L) <- -+heard([gone(N)|L]).
"""


class Fleets:
    """Members of one fleet, on a simulated network."""

    def __init__(self) -> None:
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))

    def member(self, name: str) -> Mas:
        """Return a system that joins under a name."""
        return Mas(name=name, join=joining(self.network.carrier(), name))


def run(test: Callable[[Fleets], Awaitable[None]]) -> None:
    async def main() -> None:
        await test(Fleets())

    jacaros.run(main(), clock="fast")


def test_an_agent_perceives_members_that_come_get_lost_return_and_leave() -> None:
    async def test(fleets: Fleets) -> None:
        async with fleets.member("here") as here:
            ann = here.add_agent("ann", WATCH, focus=["fleet"])
            await ann.until("heard([n(here, self)])", timeout=1)
            async with fleets.member("there"):
                await ann.until("heard([n(there, joined)|_])", timeout=1)
                fleets.network.cut("here", "there")
                await ann.until("heard([n(there, lost)|_])", timeout=3)
                fleets.network.heal("here", "there")
                await ann.until("heard([n(there, joined)|_])", timeout=3)
            await ann.until("heard([gone(there)|_])", timeout=3)
            assert ann.believes("fleet_member(here, self)")
            assert not ann.believes("fleet_member(there, _)")
            assert not ann.believes("fleet_clock(there, _)")

    run(test)


def test_a_member_that_is_lost_for_a_minute_has_left_and_may_return() -> None:
    async def test(fleets: Fleets) -> None:
        async with fleets.member("here") as here, fleets.member("there"):
            ann = here.add_agent("ann", WATCH, focus=["fleet"])
            await ann.until("fleet_member(there, joined)", timeout=1)
            fleets.network.cut("here", "there")
            await ann.until("heard([n(there, lost)|_])", timeout=3)
            await ann.until("heard([gone(there)|_])", timeout=61)
            fleets.network.heal("here", "there")
            await ann.until("heard([n(there, joined)|_])", timeout=3)

    run(test)


def test_the_artifact_is_in_its_own_system_only() -> None:
    async def test(fleets: Fleets) -> None:
        async with fleets.member("here") as here, fleets.member("there") as there:
            here.environment, there.environment  # noqa: B018 - created at their first use
            await here.sleep(2)
            mains = [each for each in here.environment.workspaces() if each.name.startswith("main")]
            assert [each.path for each in mains] == ["/main", "/main@there"]
            assert mains[0].lookup("fleet").type_name == "Fleet"
            assert "fleet" not in [each.name for each in mains[1].artifacts()]

    run(test)


def test_an_artifact_of_the_project_has_precedence(tmp_path: Path) -> None:
    (tmp_path / "artifacts.py").write_text(
        "from jacaros.artifacts import Artifact\n"
        "class Ships(Artifact):\n"
        "    def init(self) -> None:\n"
        "        self.define_property('ships', 3)\n"
    )
    (tmp_path / "ann.asl").write_text("")
    (tmp_path / "port.jcm").write_text(
        "mas port { agent ann { focus: main.fleet } workspace main { artifact fleet: Ships() } }"
    )
    warnings: list[str] = []

    async def test(fleets: Fleets) -> None:
        carrier = fleets.network.carrier()
        project = Mas(
            tmp_path / "port.jcm",
            join=joining(carrier, "port"),
            on_log=lambda text, level: warnings.append(text),
        )
        async with project as port:
            await port.agent("ann").until("ships(3)", timeout=1)
        assert "[fleet] agents do not perceive the members: the project has an artifact `fleet`" in warnings

    run(test)


def test_a_lone_program_focuses_the_fleet_and_agents_of_projects_choose(tmp_path: Path) -> None:
    (tmp_path / "robot.asl").write_text("!start. +!start.")
    (tmp_path / "lab.jcm").write_text(
        "mas lab { agent robot agent one: robot.asl { focus: fleet } agent two: robot.asl { focus: main.fleet } }"
    )
    (lone,) = in_fleet(load_deployment(tmp_path / "robot.asl")).agents
    assert [(each.artifact, each.workspace) for each in lone.focus] == [("fleet", "main")]
    deployment = in_fleet(load_deployment(tmp_path / "lab.jcm"))
    assert [each.focus for each in deployment.agents] == [(), lone.focus, lone.focus]
    assert not deployment.ignored
