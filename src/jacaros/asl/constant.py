"""Values in syntax trees that were made at run time."""

from dataclasses import dataclass

from jacaros.asl import nodes
from jacaros.asl.formatter import format_term
from jacaros.terms.text import text
from jacaros.terms.values import Term


@dataclass(frozen=True, slots=True)
class Constant(nodes.Node):
    """A value that is no text: a shared variable, a map, a reference."""

    value: Term


@format_term.register
def _(node: Constant) -> str:
    return text(node.value)
