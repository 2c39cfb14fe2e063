"""Operations of a mapping as methods, with names, arities and outputs as if written in Python."""

import inspect
from collections.abc import Callable
from typing import Any

from jacaros.artifacts.env.arbiter import WHEELS
from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.mapping.declared import ArtifactPart, OperationKind, OperationPart
from jacaros.ros.guarded import VELOCITIES

Words = Callable[[ArtifactPart, OperationPart], dict[str, str]]
"""Describes the parameters of an operation, for manuals."""


def methods(part: ArtifactPart, words: Words) -> dict[str, Callable[..., Any]]:
    """Return the operations of an artifact, by names that cannot clash with methods of a class."""
    return {f"mapped {number}": _method(part, number, words) for number in range(len(part.operations))}


def _method(artifact: ArtifactPart, number: int, words: Words) -> Callable[..., Any]:
    part = artifact.operations[number]
    inputs = len(part.parameters)

    async def run(self: Any, *arguments: object) -> None:
        outs = [out for out in arguments[inputs:] if isinstance(out, Out)]
        await self.operating.run(number, arguments[:inputs], outs)

    names = [*part.parameters, *unlike(part.parameters, artifact.output_names(part))]
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    run.__signature__ = inspect.Signature(  # type: ignore[attr-defined]  # read by inspect.signature
        [inspect.Parameter(name, kind) for name in ("self", *names)]
    )
    run.__annotations__ = dict.fromkeys(names[inputs:], Out)
    run.__qualname__ = run.__name__ = part.name
    run.__doc__ = description(part)
    run.parameter_words = lambda: words(artifact, part)  # type: ignore[attr-defined]  # for manuals
    return operation(name=part.name, pausable=is_pausable(part), uses=part.uses)(run)


def is_pausable(part: OperationPart) -> bool:
    """Return whether it reacts when its intention is suspended."""
    return part.kind is OperationKind.PUBLISH or (
        part.kind is OperationKind.ACTION and part.suspend != "go_on"
    )


def motion_uses(artifact: ArtifactPart) -> tuple[str, ...]:
    """Return the resources of operations that are motions without declaring resources: repeated velocities."""
    moves = any(
        part.kind is OperationKind.PUBLISH
        and part.rate is not None
        and not part.uses
        and (part.type_name is None or part.type_name.text in VELOCITIES)
        for part in artifact.operations
    )
    return (WHEELS,) if moves else ()


def unlike(taken: tuple[str, ...], names: list[str]) -> list[str]:
    """Return the same names, with numbers appended to duplicates."""
    seen, found = set(taken), []
    for name in names:
        plain = "".join(c if c.isalnum() or c == "_" else "_" for c in name)
        wanted, number = plain, 2
        while wanted in seen or not wanted.isidentifier():
            wanted, number = f"{plain}{number}" if plain.isidentifier() else f"value{number}", number + 1
        seen.add(wanted)
        found.append(wanted)
    return found


def description(part: OperationPart) -> str:
    """Describe an operation."""
    of_type = f" ({part.type_name.text})" if part.type_name is not None else ""
    named = ", ".join(each.text for each in part.properties)
    usual = {
        OperationKind.PUBLISH: f"Publishes on {part.target.text}{of_type}.",
        OperationKind.SERVICE: f"Calls the service {part.target.text}{of_type}.",
        OperationKind.ACTION: f"Runs a goal of the action {part.target.text}{of_type}.",
        OperationKind.SET: f"Sets the parameter {part.target.text} of {part.node or 'our own node'}.",
        OperationKind.GET: f"Gives the parameter {part.target.text} of {part.node or 'our own node'}.",
        OperationKind.REFRESH: f"Updates {named} to the newest values.",
        OperationKind.READ: f"Gives the newest values of {named}.",
    }
    return part.description or usual[part.kind]
