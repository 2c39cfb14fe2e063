"""Code for internal actions in conditions: they are called, and may have answers."""

from jacaros.asl import nodes
from jacaros.asl.walk import names_in
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.answers import undoing
from jacaros.bdi.fast.generated.building import build, resolved
from jacaros.bdi.fast.generated.function import FunctionBuilder
from jacaros.bdi.fast.generated.matching import Then, match, settle_fresh


def internal_action(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    """A call of an internal action, with its arguments as values."""
    action = fn.unit.actions.get(node.name)
    names = names_in(node)
    if action is None:
        undoing(fn, f"unknown(agent.context, {node.name!r})", names, then)
        return
    constant = fn.constant(action)
    if _gives_values(fn, action, node):
        variable, *others = node.arguments
        rest = "".join(f", {resolved(fn, build(fn, a))}" for a in others)
        value = fn.local("c")
        with fn.writer.block(f"for {value} in values_of(agent.context, {constant}{rest}):"):
            match(fn, variable, value, then)
        return
    arguments = "".join(f", {resolved(fn, build(fn, a))}" for a in node.arguments)
    if fn.quiet and action.body_only:
        undoing(fn, f"cannot_wait(agent.context, {constant})", names, then)
    elif not action.takes(len(node.arguments)):
        refusal = "refuse_quietly(agent.context, " if fn.quiet else "refuse("
        undoing(fn, f"{refusal}{constant}, {len(node.arguments)})", names, then)
    elif not action.backtracks:
        undoing(fn, f"holds(agent.context, t, {constant}{arguments})", names, then)
    elif not fn.quiet:
        undoing(fn, f"first_answer_of(agent.context, t, {constant}{arguments})", names, then)
    else:
        mark = fn.local("n")
        fn.line(f"{mark} = len(t)")
        with fn.writer.block(f"for _ in answers_of(agent.context, t, {constant}{arguments}):"):
            settle_fresh(fn, names)
            then()
        fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def _gives_values(fn: FunctionBuilder, action: InternalAction, node: nodes.InternalAction) -> bool:
    """Whether a call is answered by values for its first argument, a variable that is met here for the first time."""
    if action.values is None or not fn.quiet or not action.takes(len(node.arguments)):
        return False
    variable, *others = node.arguments
    return (
        isinstance(variable, nodes.Variable)
        and variable.annotations is None
        and variable.namespace is None
        and not variable.negated
        and (variable.unnamed or variable.name not in fn.values)
        and all(name in fn.values and name != variable.name for other in others for name in names_in(other))
    )
