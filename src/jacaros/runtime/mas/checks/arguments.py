"""Check that agents give values to the inputs of operations."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import walk
from jacaros.artifacts.env.values import Out
from jacaros.artifacts.kernel.acceptance import Unsuitable
from jacaros.artifacts.kernel.declaration import Parameter

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact


def unbound_arguments(plans: Iterable[nodes.Plan], types: "Sequence[type[Artifact]]") -> Iterator[Diagnostic]:
    """Return warnings about variables without a value as inputs of operations that only artifacts of *types* have."""
    for plan in plans:
        met: set[str] = set()
        for node in walk(plan):
            if isinstance(node, nodes.Variable):
                met.add(node.name)
            elif isinstance(node, nodes.ExternalAction) and isinstance(node.action, nodes.Literal):
                yield from _unbound(node.action, met, types)


def _unbound(action: nodes.Literal, met: set[str], types: "Sequence[type[Artifact]]") -> Iterator[Diagnostic]:
    count = len(action.arguments)
    found = [each.interface.operations.find(action.functor, count) for each in types]
    parameters = [
        each.signature.parameters for each in found if each is not None and each.signature.rest is None
    ]
    for place, argument in enumerate(action.arguments):
        if parameters and isinstance(argument, nodes.Variable) and argument.name not in met:
            wanted = [each[place] for each in parameters]
            if not any(map(_takes_outputs, wanted)):
                shown = "_" if argument.unnamed else argument.name
                message = f"`{shown}` has no value here: `{action.functor}/{count}` needs one for `{wanted[0].name}`"
                help = "give it a value before the call, as in `?b(X)` or `X = 3`, or write the value"
                yield Diagnostic("warning", message, argument.span, help, "unbound-argument")


def _takes_outputs(parameter: Parameter) -> bool:
    """Return whether a parameter may be an output."""
    try:
        parameter.accept(Out())
    except Unsuitable:
        return parameter.output
    return True
