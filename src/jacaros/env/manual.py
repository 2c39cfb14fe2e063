"""Manuals: what an artifact type offers, for agents, people and the inspector."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass

from jacaros.env.artifact import Artifact
from jacaros.env.kernel.declaration import DeclaredOperation
from jacaros.env.kernel.interface import Interface
from jacaros.env.kernel.signature import Signature, signature_of


@dataclass(frozen=True, slots=True)
class ParameterManual:
    """One parameter.

    Attributes:
        name: its name.
        expected: the kind of value it takes, for people.
        output: True when it is an output.
        optional: True when it may be left out.
    """

    name: str
    expected: str
    output: bool
    optional: bool


@dataclass(frozen=True, slots=True)
class OperationManual:
    """One operation.

    Attributes:
        name: what its callers call it.
        kind: ``operation``, ``linked operation`` or ``internal operation``.
        usage: name and parameters in one line, outputs with a minus sign.
        parameters: those with a place of their own.
        more: True when any number of further arguments may follow.
        text: what it does, as its author describes it.
        guarded: True when it may have to wait before it begins.
        pausable: True when it stops while the intention that asked for it is suspended.
    """

    name: str
    kind: str
    usage: str
    parameters: tuple[ParameterManual, ...]
    more: bool
    text: str
    guarded: bool
    pausable: bool


@dataclass(frozen=True, slots=True)
class Manual:
    """An artifact type.

    Attributes:
        type_name: name of the class.
        text: what it is for, as its author describes it.
        usage: how it is made: ``init`` with its parameters.
        operations: its operations: for agents, for other artifacts, for itself.
        ports: its out ports.
    """

    type_name: str
    text: str
    usage: str
    operations: tuple[OperationManual, ...]
    ports: tuple[str, ...]

    def __str__(self) -> str:
        lines = [f"{self.type_name}: {self.text}".rstrip(": "), f"  {self.usage}"]
        for each in self.operations:
            lines.append(f"  {each.kind} {each.usage}")
            lines += [f"      {line}".rstrip() for line in each.text.splitlines()]
        if self.ports:
            lines.append(f"  out ports {', '.join(self.ports)}")
        return "\n".join(lines)


def describe(artifact_type: type[Artifact], interface: Interface | None = None) -> Manual:
    """Describe what artifacts of *artifact_type* offer.

    Args:
        artifact_type: the class.
        interface: the operations of one artifact that defines more of its own (`Workspace.interface`).
    """
    offered = interface if interface is not None else artifact_type.interface
    tables = (offered.operations, offered.links, offered.internals)
    init = getattr(artifact_type, "init", None)
    return Manual(
        artifact_type.__name__,
        inspect.cleandoc(artifact_type.__doc__ or ""),
        f"init({signature_of(init, skip_first=True) if init is not None else ''})",
        tuple(_describe(declared) for table in tables for declared in table),
        tuple(artifact_type.ports),
    )


def _describe(declared: DeclaredOperation) -> OperationManual:
    signature = declared.signature
    return OperationManual(
        declared.name,
        declared.kind,
        f"{declared.name}({signature})",
        _parameters(signature),
        signature.rest is not None,
        _text(declared.source),
        declared.guard is not None,
        declared.pausable,
    )


def _parameters(signature: Signature) -> tuple[ParameterManual, ...]:
    return tuple(ParameterManual(p.name, p.expected, p.output, p.optional) for p in signature.parameters)


def _text(source: Callable[..., object]) -> str:
    return inspect.cleandoc(source.__doc__ or "")
