"""The command that calls an operation of an artifact."""

import asyncio
from collections.abc import Mapping
from typing import Any

from jacaros.agents.body.values import Outputs, to_value
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import Names, lower_value
from jacaros.agents.terms.values import Var, bare
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.values import text as value_text
from jacaros.inspector.live.commands import Command, Given, Refused, text_in
from jacaros.mas.system import System
from jacaros.runtime.clock import of_run

YOU = "you"
"""Caller of operations called on the page."""


def artifact_commands(system: System) -> Mapping[str, Command]:
    """Return the commands for the artifacts of a system."""

    async def operate(given: Given) -> str:
        environment = system.environment
        if environment is None:
            raise Refused("this run has no artifacts")
        return await _operate(environment, text_in(given, "artifact"), text_in(given, "text"))

    return {"operate": operate}


async def _operate(environment: Environment, artifact: str, written: str) -> str:
    """Call an operation such as ``moveForward(1)``, wait for its end, and return its results as text."""
    target = _find(environment, artifact)
    names = Names()
    outputs: Outputs = []
    term: Any = bare(lower_value(parse_literal(written), names.__getitem__))
    arguments = term[1:] if term.__class__ is tuple else ()
    name = term[0].name if term.__class__ is tuple else term.name
    values = tuple(to_value(each, outputs) for each in arguments)
    ended: asyncio.Future[OperationOutcome] = asyncio.get_running_loop().create_future()

    def done(outcome: OperationOutcome) -> None:
        if not ended.done():
            ended.set_result(outcome)

    with of_run():
        environment.execute(OperationRequest(target, name, values, YOU, None, done, None))
    outcome = await ended
    if not outcome.ok:
        why = outcome.message or (value_text(outcome.reason) if outcome.reason is not None else "it failed")
        raise Refused(why)
    results = ((name, _value_of(variable, outputs)) for name, variable in names.items())
    return ", ".join(f"{name} = {value}" for name, value in results)


def _value_of(variable: Var, outputs: Outputs) -> str:
    """Return the value of an output variable, ``_`` for none."""
    found = next((out for each, out in outputs if each is variable), None)
    return value_text(found.value) if found is not None and found.is_set else "_"


def _find(environment: Environment, artifact: str) -> ArtifactId:
    known = [each for workspace in environment.workspaces() for each in workspace.artifacts()]
    for each in known:
        if artifact in (each.path, each.name):
            return each
    raise Refused(f"unknown artifact: `{artifact[:80]}`")
