"""Labels of plans: two different plans cannot share one."""

from jacaros.asl import nodes
from jacaros.asl.diagnostics import Diagnostic


def check_labels(plans: list[nodes.Plan], diagnostics: list[Diagnostic]) -> None:
    """Report labels that two different plans have; repetitions of one and the same plan are taken out.

    Repetitions come about when a file is included twice.  *plans* is changed in place.
    """
    known: dict[tuple[object, str], nodes.Plan] = {}
    repeated: list[int] = []
    for index, plan in enumerate(plans):
        if plan.subplans:
            check_labels(list(plan.subplans), diagnostics)
        if not isinstance(plan.label, nodes.Literal):
            continue
        first = known.setdefault((plan.label.namespace, plan.label.functor), plan)
        if first is plan:
            continue
        if shape(first) == shape(plan):
            repeated.append(index)
        else:
            diagnostics.append(_two_plans(first, plan))
    for index in reversed(repeated):
        del plans[index]


def _two_plans(first: nodes.Plan, second: nodes.Plan) -> Diagnostic:
    assert isinstance(second.label, nodes.Literal)
    where = ""
    if first.span is not None:
        file = first.span.file.name
        elsewhere = second.span is None or second.span.file.name != file
        where = f"; the first one is at {f'{file}, ' if elsewhere else ''}line {first.span.line}"
    return Diagnostic(
        "error",
        f"two different plans have one label, @{second.label.functor}{where}",
        second.label.span or second.span,
        "give one of them another label",
        "duplicate-label",
    )


def shape(node: object, names: dict[str, int] | None = None) -> object:
    """The tree without places and with variables numbered, to be compared: equal for trees that differ in the names
    of their variables only."""
    names = {} if names is None else names
    if isinstance(node, nodes.Variable):
        number = names.setdefault(node.name, len(names))
        return (number, shape(node.annotations, names), shape(node.namespace, names), node.negated)
    if isinstance(node, tuple):
        return tuple([shape(part, names) for part in node])
    if isinstance(node, nodes.Node):
        return (type(node).__name__, *[shape(part, names) for part in node.parts()])
    return node
