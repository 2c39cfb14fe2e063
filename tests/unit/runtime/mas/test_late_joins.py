"""Workspaces that appear after the start, and may vanish and return: agents of the project join them."""

from collections.abc import Callable
from typing import Any

from jacaros.artifacts import Artifact, Environment, Session
from jacaros.runtime.mas.deployment import FocusSpec
from jacaros.runtime.mas.late_joins import LateJoin
from jacaros.testing import RunResult
from played import played
from stage_lab import play

Ran = Callable[..., RunResult]

ATTIC = "/main/attic"


class Lamp(Artifact):
    def init(self, colour: str) -> None:
        self.define_property("colour", colour)


class Away:
    """A workspace of another process, which can be mounted."""

    def __init__(self, stage: Any) -> None:
        self.workspace = Environment(stage.clock).create_workspace(ATTIC)
        self._mount = stage.environment.mount

    async def arrive(self, colour: str) -> None:
        self.leave = self._mount(self.workspace)
        self.lamp = await self.workspace.make_artifact("lamp", Lamp, [colour])

    def vanish(self) -> None:
        self.workspace.dispose_artifact(self.lamp)
        self.leave()


def bob_waits(stage: Any, before: tuple[str, ...] = ()) -> Session:
    session = Session(stage.environment, "bob")
    LateJoin(session.presence, ATTIC, [FocusSpec("lamp", ATTIC)], before)
    return session


def joined(session: Session) -> list[str]:
    return [each.path for each in session.presence.workspaces.joined()]


@played(play)
async def test_a_workspace_is_joined_and_its_artifacts_focused_when_they_appear(stage: Any) -> None:
    session = bob_waits(stage)
    assert joined(session) == ["/main"]
    await Away(stage).arrive("red")
    assert joined(session) == ["/main", ATTIC]
    assert session.value("colour") == "red"


@played(play)
async def test_a_workspace_that_returns_is_focused_again(stage: Any) -> None:
    session = bob_waits(stage)
    first, second = Away(stage), Away(stage)
    await first.arrive("red")
    first.vanish()
    assert not session.has_property("colour")
    await second.arrive("green")
    assert session.value("colour") == "green"
    assert session.presence.workspaces.at(ATTIC) is second.workspace


@played(play)
async def test_a_workspace_that_the_agent_has_quit_is_not_joined_again(stage: Any) -> None:
    session = bob_waits(stage)
    first = Away(stage)
    await first.arrive("red")
    session.presence.quit(first.workspace)
    first.vanish()
    await Away(stage).arrive("green")
    assert joined(session) == ["/main"]


@played(play)
async def test_an_agent_that_has_ended_joins_nothing(stage: Any) -> None:
    session = bob_waits(stage)
    session.close()
    await Away(stage).arrive("red")
    assert joined(session) == []


@played(play)
async def test_the_current_workspace_is_the_last_one_of_the_project(stage: Any) -> None:
    hall = stage.environment.create_workspace("/main/hall")
    found = []
    for before in ((), (hall.path,)):
        session = bob_waits(stage, before)
        session.presence.join(hall)
        found.append(session)
    await Away(stage).arrive("red")
    assert [each.presence.workspaces.current().path for each in found] == [hall.path, ATTIC]


def test_a_project_joins_a_workspace_that_another_agent_creates(ran: Ran) -> None:
    result = ran(
        p_jcm="""mas p {
            agent ann: a.asl { focus: attic.c@there }
            agent bob: b.asl { node: there }
            workspace hall
            node here
            node there
        }""",
        a_asl="+count(X) <- .print(X).",
        b_asl='!go. +!go <- .wait(100); createWorkspace("attic"); joinWorkspace("attic"); makeArtifact("c", "Counter").',
        artifacts_py="""
from jacaros.artifacts import Artifact

class Counter(Artifact):
    def init(self):
        self.define_property("count", 3)
""",
    )
    assert (result.of("ann"), result.errors) == (["3"], [])
