"""Artifacts of a run as callers outside meet them, and the questions of the artifact ``Operator`` to a person."""

import asyncio
from collections.abc import Iterator
from typing import Any

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.env.values import text as value_text
from jacaros.runtime.clock import of_run
from jacaros.serving.callers import RequestError


def all_artifacts(environment: Environment | None) -> Iterator[tuple[Any, ArtifactId]]:
    """Yield all artifacts with their workspaces."""
    for workspace in environment.workspaces() if environment is not None else ():
        for artifact in workspace.artifacts():
            yield workspace, artifact


def artifacts(environment: Environment | None) -> list[dict[str, str]]:
    """Return names, paths and types of all artifacts."""
    return [
        {"name": each.name, "path": each.path, "type": each.type_name}
        for _, each in all_artifacts(environment)
    ]


def questions(environment: Environment | None) -> list[dict[str, Any]]:
    """Return the open questions to a person; their ``id`` consists of the artifact's name and a number."""
    return [
        {
            "id": f"{artifact.name}-{number}",
            "artifact": artifact.path,
            "text": text,
            "options": [*map(value_text, options)],
        }
        for workspace, artifact in all_artifacts(environment)
        if artifact.type_name == "Operator"
        for number, text, options in _open(workspace, artifact)
    ]


def _open(workspace: Any, artifact: ArtifactId) -> list[tuple[Any, ...]]:
    return [tuple(each.values) for each in workspace.properties(artifact) if each.name == "question"]


async def answer(environment: Environment | None, id: str, given: str | int, by: str) -> None:
    """Answer a question to a person.

    Args:
        id: name or path of the artifact, ``-``, and the number of the question.
        given: a text, or the number of an option.
        by: who answers.

    Raises:
        RequestError: the question is unknown, or this is not one of its options.
    """
    name, _, number = id.rpartition("-")
    found = [
        artifact
        for workspace, artifact in all_artifacts(environment)
        if artifact.type_name == "Operator" and name in (artifact.name, artifact.path)
        if any(str(each[0]) == number for each in _open(workspace, artifact))
    ]
    if not found:
        raise RequestError("unknown_question", f"no open question `{id[:80]}`")
    value = given if isinstance(given, str) else Structure("option", (given,))
    assert environment is not None
    await call(environment, found[0], "answer", (int(number), value), by)


async def call(
    environment: Environment, artifact: ArtifactId, name: str, values: tuple[object, ...], by: str
) -> None:
    """Call an operation, and wait for its end.

    Raises:
        RequestError: it fails.
    """
    ended: asyncio.Future[OperationOutcome] = asyncio.get_running_loop().create_future()

    def done(outcome: OperationOutcome) -> None:
        if not ended.done():
            ended.set_result(outcome)

    with of_run():
        environment.execute(OperationRequest(artifact, name, values, by, None, done, None))
    outcome = await ended
    if not outcome.ok:
        why = outcome.message or (value_text(outcome.reason) if outcome.reason is not None else "it failed")
        raise RequestError("invalid_arguments", why)
