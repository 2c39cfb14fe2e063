"""Parameters of our own node in mapping files, on the graph inside the process."""

import math

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, made

from jacaros.artifacts import ArtifactId, Atom
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.robots.ros.errors import ParameterRefused
from jacaros.robots.ros.parameter import DeclaredParameter

TUNED = """
parameters:
  speed: {default: 0.4, minimum: 0.1, maximum: 1.0, description: metres per second}
  turn: {default: 0.5, fields: {path: ., unit: degrees, round: 0}, parameter: patrol.turn}
  places: {default: [kitchen, hall], fields: {path: ., as: atom}}
  map_file: {default: house.yaml, read_only: true}
  count: 3
operations:
  drive_at: {parameters: [v], set_parameter: speed, value: $v}
"""


def held(lab: Lab, artifact: ArtifactId, name: str) -> list[tuple[object, ...]]:
    """The present values of a property."""
    return lab.watch(artifact).holds(name)


pytestmark = made(mapped(TUNED))


async def test_they_are_properties_from_the_start(lab: Lab, artifact: ArtifactId) -> None:
    assert held(lab, artifact, "speed") == [(0.4,)]
    assert held(lab, artifact, "turn") == [(29,)]
    assert held(lab, artifact, "places") == [([Atom("kitchen"), Atom("hall")],)]
    assert isinstance(held(lab, artifact, "places")[0][0][0], Atom)
    assert held(lab, artifact, "map_file") == [("house.yaml",)]
    assert held(lab, artifact, "count") == [(3,)]
    names = await lab.backend.parameters().names()
    assert names == ["count", "map_file", "patrol.turn", "places", "speed"]


async def test_others_change_them_within_what_is_declared(lab: Lab, artifact: ArtifactId) -> None:
    theirs = lab.backend.parameters()
    await theirs.set("speed", 0.8)
    await theirs.set("places", ["attic"])
    for name, value in (("speed", 2.0), ("speed", "fast"), ("map_file", "other.yaml"), ("count", 1.5)):
        with pytest.raises(ParameterRefused):
            await theirs.set(name, value)
    await settle()
    assert held(lab, artifact, "speed") == [(0.8,)]
    assert held(lab, artifact, "places") == [([Atom("attic")],)]
    assert held(lab, artifact, "map_file") == [("house.yaml",)]


async def test_agents_change_them_by_operations(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "drive_at", 1)
    await settle()
    assert held(lab, artifact, "speed") == [(1.0,)]
    assert await lab.backend.parameters().get("speed") == 1.0
    assert (await lab.call(artifact, "drive_at", 7)).reason == "parameter_refused(speed)"


async def test_those_of_several_robots_are_below_their_names(lab: Lab) -> None:
    first = await lab.make(mapped(TUNED), "r1", name="first")
    await lab.make(mapped(TUNED), "r2", name="second")
    names = await lab.backend.parameters().names()
    assert [each for each in names if "speed" in each] == ["r1.speed", "r2.speed"]
    await lab.do(first, "drive_at", 0.2)
    assert await lab.backend.parameters().get("r1.speed") == 0.2
    assert await lab.backend.parameters().get("r2.speed") == 0.4


async def test_they_go_with_their_artifact(lab: Lab, artifact: ArtifactId) -> None:
    lab.workspace.dispose_artifact(artifact)
    assert await lab.backend.parameters().names() == []
    await lab.make(mapped(TUNED))


async def test_infinity_is_not_shown(lab: Lab, artifact: ArtifactId) -> None:
    theirs = lab.backend.parameters()
    await theirs.set("patrol.turn", -math.inf)
    await settle()
    assert held(lab, artifact, "turn") == [(29,)]
    assert any("turn is -inf" in line for line in lab.logged)
    await theirs.set("patrol.turn", 1.0)
    await settle()
    assert held(lab, artifact, "turn") == [(57,)]


async def test_a_duplicate_declaration_is_reported_with_its_line(lab: Lab) -> None:
    lab.backend.parameters().declare("speed", DeclaredParameter(1))
    with pytest.raises(OperationFailed) as failed:
        await lab.make(mapped(TUNED))
    told = failed.value.message
    assert "m.yaml:3:3: error: parameter speed of /lab is already declared" in told
    assert "  = help: give it another name: parameter: NAME" in told
    assert await lab.backend.parameters().names() == ["speed"]
