"""Generated code: it shows the agent program to tracebacks, and is made only when needed."""

import traceback

from jacaros.asl.loader import load_program
from jacaros.bdi.internal_action import InternalAction
from jacaros.compiler.plan import Plan, label_of
from jacaros.compiler.triggers import trigger
from jacaros.compiler.unit import compile_select
from jacaros.terms.unifier import Trail
from jacaros.terms.values import BY_SELF, atom, functor


class Bare:
    """As little of an agent as a select function needs."""

    def __init__(self) -> None:
        self.trail = Trail()
        self.context = self


def broken(ctx: object, *arguments: object) -> None:
    del ctx, arguments
    raise ZeroDivisionError("on purpose")


def selected(program: str, actions: dict[str, InternalAction] | None = None) -> list[object]:
    tree, _ = load_program("robot.asl", program)
    plans = [Plan(node, label_of(node, i)) for i, node in enumerate(tree.plans)]
    kind = trigger("+", "!", functor("g", 1))
    select, _ = compile_select(kind, plans, actions or {})
    frame = select(Bare(), (kind, 3.0), BY_SELF)
    assert frame is not None
    return frame


def test_a_traceback_shows_file_and_line_of_the_agent_program() -> None:
    actions = {".bad": InternalAction(".bad", broken)}
    frame = selected("\n\n+!g(X) <-\n  .bad(X).", actions)
    step = frame[0]
    try:
        step(Bare(), frame)  # type: ignore[operator]
    except ZeroDivisionError as fault:
        places = [(entry.filename, entry.lineno) for entry in traceback.extract_tb(fault.__traceback__)]
    assert ("robot.asl", 4) in places


def test_position_and_bindings_of_a_frame_can_be_read() -> None:
    frame = selected("+!g(X) : Y = X + 1 <- .stop(Y, X).", {".stop": InternalAction(".stop", broken)})
    plan = frame[4]
    assert isinstance(plan, Plan)
    assert {name: frame[slot] for name, slot in plan.slots.items()} == {"X": 3.0, "Y": 4.0}
    assert plan.label is atom("p__0")


def test_a_goal_kind_is_one_object() -> None:
    assert trigger("+", "!", functor("g", 1)) is trigger("+", "!", functor("g", 1))
    assert trigger("+", "!", functor("g", 1)).on_fail is trigger("-", "!", functor("g", 1))
