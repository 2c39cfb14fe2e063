"""Steps of plans as text, with the values of their variables."""

from jacaros.asl import nodes
from jacaros.terms.text import text
from jacaros.terms.values import String, Term


def step_text(node: nodes.Node, term: Term) -> str:
    """Return a step as text, with the values of its variables; *term* is its formula."""
    shown = str(term) if term.__class__ is String else text(term)
    if isinstance(node, nodes.Test):
        return f"?{shown}"
    if isinstance(node, nodes.BeliefChange):
        return f"{node.operator}{shown}"
    if isinstance(node, nodes.Achieve):
        return f"!{shown}"
    if isinstance(node, (nodes.If, nodes.While)):
        return f"{'if' if isinstance(node, nodes.If) else 'while'} ({unbracketed(shown)})"
    return unbracketed(shown)


def unbracketed(shown: str) -> str:
    """Return an operator's term without the brackets around it."""
    if not (shown.startswith("(") and shown.endswith(")")):
        return shown
    depth = 0
    for position, character in enumerate(shown):
        depth += (character == "(") - (character == ")")
        if not depth:
            return shown[1:-1] if position == len(shown) - 1 else shown
    return shown
