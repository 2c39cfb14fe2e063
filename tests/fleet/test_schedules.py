"""A thousand random schedules on a simulated network, against a model of what a fleet promises."""

from collections import Counter as Tally

import pytest
from scheduled import Fleet, Run

import jacaros
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.property import Observation

SCHEDULES = 1000
PARTS = 10
LATE = 5.0
"""Seconds within which an operation is cancelled whose caller knows that it failed."""


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_random_schedules_keep_the_promises_of_a_fleet(part: int) -> None:
    for seed in range(part, SCHEDULES, PARTS):
        faults = jacaros.run(_faults_of(seed), clock="fast")
        assert not faults, f"seed {seed}:\n" + "\n".join(faults)


async def _faults_of(seed: int) -> list[str]:
    fleet = Fleet(seed)
    try:
        await fleet.play()
        return [*fleet.faults, *_messages(fleet), *_operations(fleet), *_copies(fleet), *_focuses(fleet)]
    finally:
        await fleet.stop()


def _messages(fleet: Fleet) -> list[str]:
    """Return which messages came twice, out of order, or neither to their receivers nor back."""
    faults = []
    for note in fleet.notes.values():
        told = [each for each in note.outcomes if each != "answer"]
        if note.what == "operation":
            continue
        if note.arrivals > 1 or len(told) > 1 or note.outcomes.count("answer") > 1:
            faults.append(f"more than once: {note}")
        elif note.by.ended or (note.refused_by is not None and note.refused_by.ended):
            continue
        elif note.what == "tell" and told != ["unconfirmed"] and note.arrivals + len(told) != 1:
            faults.append(f"not either delivered or returned: {note}")
        elif note.what == "askOne" and not note.outcomes:
            faults.append(f"without an answer: {note}")
    for (sender, receiver), numbers in fleet.arrived.items():
        if numbers != sorted(numbers):
            faults.append(f"out of order from {sender} to {receiver}: {numbers}")
    return faults


def _operations(fleet: Fleet) -> list[str]:
    """Return which operations took effect twice, or not although they succeeded, or have no outcome."""
    times = [each for run in (*fleet.runs.values(), *fleet.ended) for each in run.effects]
    effects = Tally(number for number, _ in times)
    faults = [f"effect of {number} came {often} times" for number, often in effects.items() if often > 1]
    faults += [
        f"effect long after the failure: {note}"
        for number, at in times
        if (note := fleet.notes[str(number)]).outcomes and at > note.ended_at + LATE
    ]
    for number, note in fleet.notes.items():
        if note.what == "operation" and note.outcomes == ["ok"] and effects[int(number)] != 1:
            faults.append(f"no effect: {note}")
    faults += [
        f"not one outcome: {note}"
        for note in fleet.operations
        if len(note.outcomes) > 1 or (not note.outcomes and not note.by.ended)
    ]
    return faults


def _called(run: Run, fleet: Fleet, agent: str, of: Run) -> str:
    """Return how an agent of a run is called at another one."""
    is_unique = sum(agent in [each.name for each in other.agents] for other in fleet.runs.values()) == 1
    return agent if run is of or is_unique else f"{agent}@{of.id.name}"


def _copies(fleet: Fleet) -> list[str]:
    """Return which copies of names, services, workspaces and artifacts differ from their originals."""
    faults = []
    for run in fleet.runs.values():
        members = list(fleet.runs.values())
        names = {_called(run, fleet, each.name, of) for of in members for each in of.agents}
        services = {
            (_called(run, fleet, name, of), service) for of in members for name, service in of.services
        }
        places = {
            (workspace.path, artifact.name, tuple(sorted(workspace.offers(artifact))))
            for of in members
            for workspace in of.environment.own()
            if workspace.path != "/main"
            for artifact in workspace.artifacts()
        }
        seen = {
            (workspace.path, artifact.name, tuple(sorted(workspace.offers(artifact))))
            for workspace in run.environment.workspaces()
            if not workspace.path.startswith("/main@") and workspace.path != "/main"
            for artifact in workspace.artifacts()
        }
        known = {
            (name, service) for service in ("mop", "wipe") for name in run.system.services.providers(service)
        }
        found = set(run.system.directory.names()) - {"df"}
        for what, have, want in (
            ("names", found, names), ("services", known, services), ("artifacts", seen, places)
        ):  # fmt: skip
            if have != want:
                faults.append(f"{what} at {run.id}: lacks {want - have}, has {have - want}")
    return faults


class _Snapshot:
    """The properties of an artifact, seen where it is."""

    agent = "test"

    def __init__(self) -> None:
        self.properties: dict[int, tuple[str, tuple[object, ...]]] = {}

    def observe(self, seen: Observation) -> None:
        self.properties.update({each.key: (each.name, each.values) for each in seen.added})


def _original(fleet: Fleet, artifact: ArtifactId, of: str) -> dict[int, tuple[str, tuple[object, ...]]]:
    snapshot = _Snapshot()
    for workspace in fleet.runs[of].environment.own():
        for each in workspace.artifacts():
            if (workspace.path, each.name) == (artifact.workspace, artifact.name):
                workspace.focus(each, snapshot)
    return snapshot.properties


def _focuses(fleet: Fleet) -> list[str]:
    """Return which observers know other properties than those of their artifact, or heard signals twice."""
    faults = []
    for run in fleet.runs.values():
        for (artifact, agent), observed in run.focuses.items():
            of = artifact.workspace.removeprefix("/main/lab_")
            present = artifact in run.environment.workspace(artifact.workspace).artifacts()
            wanted = _original(fleet, artifact, of) if present and any(observed.outcomes) else {}
            where = f"{agent} of {run.id} observes {artifact.path}"
            if observed.known != wanted:
                faults.append(f"{where}: knows {observed.known}, not {wanted} ({observed.outcomes})")
            if len(observed.signals) != len(set(observed.signals)):
                faults.append(f"{where}: heard signals twice: {observed.signals}")
            if not observed.outcomes:
                faults.append(f"{where}: no outcome")
    return faults
