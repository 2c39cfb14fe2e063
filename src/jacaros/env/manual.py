"""Manuals: what an artifact type offers, for agents, users and the inspector."""

import inspect
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from jacaros.env.artifact import Artifact
from jacaros.env.kernel.declaration import DeclaredOperation
from jacaros.env.kernel.interface import Interface
from jacaros.env.kernel.signature import Signature
from jacaros.env.operation import INTERNAL, LINK, OPERATION
from jacaros.env.property import ObservableProperty
from jacaros.env.values import Atom, Structure

NOT_FOR_USERS = ("Properties", "Signals", "Attributes")
"""Sections of a docstring that are shown elsewhere, or are for authors of artifacts."""


@dataclass(frozen=True, slots=True)
class ParameterManual:
    """One parameter.

    Attributes:
        name: its name.
        expected: the kind of value it accepts, as text.
        output: whether it is an output.
        optional: whether it has a default value.
    """

    name: str
    expected: str
    output: bool
    optional: bool


@dataclass(frozen=True, slots=True)
class OperationManual:
    """One operation.

    Attributes:
        name: its name for callers.
        kind: ``operation``, ``linked operation``, ``internal operation``, or ``init`` for the initialisation.
        usage: name and parameters in one line, outputs with a minus sign.
        parameters: the positional parameters.
        more: whether any number of further arguments may follow.
        text: its description.
        guarded: whether it may have to wait before it begins.
        pausable: whether it pauses while the intention that called it is suspended.
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
class ObservableManual:
    """A property or a signal.

    Attributes:
        name: functor of the belief or event.
        usage: the name with words for its values.
        text: its description. Empty if it is only known from the code.
    """

    name: str
    usage: str
    text: str


@dataclass(frozen=True, slots=True)
class Manual:
    """An artifact type.

    Attributes:
        type_name: name of the class.
        text: its description.
        inits: how to create it: each ``init`` with its parameters.
        operations: its operations: for agents, for other artifacts, and internal ones.
        properties: its observable properties.
        signals: its signals.
        ports: its out ports.
    """

    type_name: str
    text: str
    inits: tuple[OperationManual, ...]
    operations: tuple[OperationManual, ...]
    properties: tuple[ObservableManual, ...]
    signals: tuple[ObservableManual, ...]
    ports: tuple[str, ...]

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> Iterator[str]:
        """Return the manual as text, without internal operations."""
        yield self.type_name
        yield from _indented(self.text, 2)
        yield from _titled("made with", map(_operation_lines, self.inits))
        yield from _titled("properties", map(_observable_lines, self.properties))
        yield from _titled("signals", map(_observable_lines, self.signals))
        for title, kind in (("operations", OPERATION), ("linked operations", LINK)):
            yield from _titled(
                title, [_operation_lines(each) for each in self.operations if each.kind == kind]
            )
        if self.ports:
            yield f"out ports: {', '.join(self.ports)}"


def _titled(title: str, parts: Iterable[Iterator[str]]) -> Iterator[str]:
    began = False
    for part in parts:
        if not began:
            yield f"{title}:"
        began = True
        yield from part


def _operation_lines(operation: OperationManual) -> Iterator[str]:
    traits = [
        word for word, has in (("may wait", operation.guarded), ("pausable", operation.pausable)) if has
    ]
    yield f"  {operation.usage}" + (f"  [{', '.join(traits)}]" if traits else "")
    yield from _indented(operation.text, 6)


def _observable_lines(observable: ObservableManual) -> Iterator[str]:
    yield f"  {observable.usage}"
    yield from _indented(observable.text, 6)


def _indented(text: str, width: int) -> Iterator[str]:
    for line in text.splitlines():
        yield f"{' ' * width}{line}".rstrip()


def describe(
    artifact_type: type[Artifact],
    interface: Interface | None = None,
    properties: Iterable[ObservableProperty] = (),
) -> Manual:
    """Return the manual of *artifact_type*.

    Properties and signals come from the sections ``Properties:`` and ``Signals:`` of its docstring, and from the names that
    its code defines and sends.

    Args:
        artifact_type: the class.
        interface: the operations of an artifact that defines more of its own (`Workspace.interface`).
        properties: the properties of an artifact.
    """
    # Imported on demand: only manuals read sources.
    from jacaros.env import manual_sources as sources

    offered = interface if interface is not None else artifact_type.interface
    tables = (offered.operations, offered.links, offered.internals)
    has = {each.name: _usage(each) for each in properties}
    written = {**has, **sources.written_properties(artifact_type)}
    return Manual(
        artifact_type.__name__,
        sources.without_sections(inspect.cleandoc(artifact_type.__doc__ or ""), NOT_FOR_USERS),
        tuple(map(_describe, offered.inits)) or (_NO_INIT,),
        tuple(_describe(declared) for table in tables for declared in table),
        _observables(sources.described(artifact_type, "Properties"), written),
        _observables(sources.described(artifact_type, "Signals"), sources.written_signals(artifact_type)),
        tuple(artifact_type.ports),
    )


_NO_INIT = OperationManual("init", "init", "init()", (), False, "", False, False)


def _usage(observed: ObservableProperty) -> str:
    return f"{observed.name}({', '.join('_' for _ in observed.values)})" if observed.values else observed.name


def _observables(told: dict[str, tuple[str, str]], written: dict[str, str]) -> tuple[ObservableManual, ...]:
    rest = {name: (usage, "") for name, usage in written.items() if name not in told}
    return tuple(ObservableManual(name, *each) for name, each in {**told, **rest}.items())


def _describe(declared: DeclaredOperation) -> OperationManual:
    signature = _worded(declared)
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


def _worded(declared: DeclaredOperation) -> Signature:
    """Return the signature, with descriptions of parameters from mapping files, which have no annotations."""
    signature = declared.signature
    words: dict[str, str] = getattr(declared.source, "parameter_words", dict)()
    parameters = [
        each._replace(expected=words.get(each.name, each.expected)) for each in signature.parameters
    ]
    return Signature(tuple(parameters), signature.rest)


def _parameters(signature: Signature) -> tuple[ParameterManual, ...]:
    return tuple(ParameterManual(p.name, p.expected, p.output, p.optional) for p in signature.parameters)


def _text(source: Callable[..., object]) -> str:
    from jacaros.env.manual_sources import without_sections

    return without_sections(inspect.cleandoc(source.__doc__ or ""), ("Raises", "Returns"))


def manual_term(manual: Manual) -> Structure:
    """Return a manual as a term for agents.

    ``manual(Type,Text,Inits,Operations,Properties,Signals,Ports)``: Type and all texts are strings, names are atoms.
    An init is ``init(Parameters,Text)``; an operation for agents ``operation(Name,Parameters,Text)``, one for other
    artifacts ``linked(Name,Parameters,Text)``. A parameter is ``input(Name,Expected)``, ``optional(Name,Expected)``,
    ``output(Name)`` or, for any number of further ones, the atom ``more``. A property is
    ``property(Name,Usage,Text)``, a signal ``signal(Name,Usage,Text)``, and a port its name.
    """
    operations = [each for each in manual.operations if each.kind != INTERNAL]
    return Structure(
        "manual",
        (
            manual.type_name,
            manual.text,
            [Structure("init", (_parameter_terms(each), each.text)) for each in manual.inits],
            [_operation_term(each) for each in operations],
            [Structure("property", (Atom(each.name), each.usage, each.text)) for each in manual.properties],
            [Structure("signal", (Atom(each.name), each.usage, each.text)) for each in manual.signals],
            [Atom(port) for port in manual.ports],
        ),
    )


def _operation_term(operation: OperationManual) -> Structure:
    functor = "linked" if operation.kind == LINK else "operation"
    return Structure(functor, (Atom(operation.name), _parameter_terms(operation), operation.text))


def _parameter_terms(operation: OperationManual) -> list[object]:
    terms: list[object] = [_parameter_term(parameter) for parameter in operation.parameters]
    return [*terms, Atom("more")] if operation.more else terms


def _parameter_term(parameter: ParameterManual) -> Structure:
    if parameter.output:
        return Structure("output", (Atom(parameter.name),))
    functor = "optional" if parameter.optional else "input"
    return Structure(functor, (Atom(parameter.name), parameter.expected))
