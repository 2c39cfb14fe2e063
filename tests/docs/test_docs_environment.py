"""Everything that agents and authors of artifacts can do with the environment is shown in a tested example."""

import re

import pytest
from pages import ROOT, blocks

from jacaros.agents.body.body import keys
from jacaros.artifacts import Artifact, describe
from jacaros.artifacts.env.environment import (
    Blackboard,
    Console,
    ManualRepository,
    SystemArtifact,
    WorkspaceArtifact,
)
from jacaros.artifacts.env.operation import OPERATION
from jacaros.artifacts.tools import Barrier, Clock, Latch
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.mas.agents.python_objects import actions

REFERENCE = ROOT / "docs" / "reference"

SAME = {"printWithAgName": "print", "printlnWithAgName": "println"}
"""Actions equivalent to others."""

REFUSED = {"crash", "createWorkspaceWithTopology", "linkRemoteWorkspace", "mountWorkspace", "spawnNode"}
"""Actions that can only fail."""

NOT_FOR_AUTHORS = {
    *("interface", "has_untaken", "observe_property", "clock", "id", "name", "workspace", "resources")
}
"""Attributes of artifacts that no author calls, that only the policies of sensors ask for, or that are plain values."""

TYPES = (Barrier, Blackboard, Clock, Console, Latch, ManualRepository, SystemArtifact, WorkspaceArtifact)


def examples(page: str, language: str) -> str:
    return "\n".join(block.text for block in blocks(REFERENCE / page) if block.language == language)


def agent_side_actions() -> list[str]:
    names = {key.rpartition("/")[0] for key in keys()}
    names |= {
        each.name
        for artifact_type in TYPES
        for each in describe(artifact_type).operations
        if each.kind == OPERATION
    }
    names |= set(actions(ProjectModules(ROOT)))
    return sorted(names - REFUSED - set(SAME))


@pytest.mark.parametrize("action", agent_side_actions())
def test_an_action_of_agents_is_shown(action: str) -> None:
    assert re.search(rf"(?<![\w.]){re.escape(action)}\b", examples("environment_actions.md", "agentspeak"))


@pytest.mark.parametrize("action", sorted(REFUSED | set(SAME)))
def test_every_other_action_is_named(action: str) -> None:
    assert action in (REFERENCE / "environment_actions.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "feature", sorted({n for n in dir(Artifact) if not n.startswith("_")} - NOT_FOR_AUTHORS)
)
def test_a_feature_of_artifacts_is_shown(feature: str) -> None:
    assert re.search(rf"\b{feature}\b", examples("artifact_programming.md", "python"))


def test_there_are_many() -> None:
    assert len(agent_side_actions()) > 35
