"""An artifact that is focused in the moment in which its workspace appears."""

import asyncio

from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, ArtifactId, Observation
from jacaros.fleet.joining import joining
from jacaros.runtime.clock import clock_of


class Door(Artifact):
    """Is open."""

    def init(self) -> None:
        self.define_property("is_open")


class Watcher:
    """Keeps what it observes."""

    agent = "ann"

    def __init__(self) -> None:
        self.seen: list[str] = []

    def observe(self, observation: Observation) -> None:
        self.seen += [f"+{each.name}" for each in observation.added]
        self.seen += [f"-{each.name}" for each in observation.removed]


def test_its_properties_come_once() -> None:
    watcher = Watcher()

    async def main() -> None:
        network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))

        def member(name: str) -> Mas:
            return Mas(name=name, join=joining(network.carrier(), name))

        async with member("there") as there:
            there.add_artifact_types(Door)
            await there.make_artifact("door", Door, [], workspace=there.create_workspace("hall"))
            async with member("here") as here:
                environment = here.environment

                def focus(artifact: ArtifactId, present: bool) -> None:
                    if present and artifact.name == "door":
                        environment.workspace("/main/hall").focus(artifact, watcher)

                def look() -> None:
                    for each in environment.workspaces():
                        if each.path == "/main/hall":
                            each.watch(focus)

                environment.watch("/main", look)
                await here.sleep(5)
                assert watcher.seen == ["+is_open"]

    jacaros.run(main(), clock="fast")
