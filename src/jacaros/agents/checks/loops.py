"""Check for goals and loops that repeat without end and without a step that takes time: they use a whole processor.

>>> from jacaros.agents.checks.goals import KnownActions
>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "!start. +!start <- +ready; !start.")
>>> [each.message for each in loops_without_wait(program, ByKind(program.plans), KnownActions({}))]
['`!start` repeats without end, and nothing in it waits or acts']
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from jacaros.agents.checks.formulas import annotations_of, is_true
from jacaros.agents.checks.goals import KnownActions, Signature, signature
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.nodes import ByKind, names_in, parts_of, walk

_PURE: Final = frozenset(
    {".concat", ".count", ".date", ".findall", ".length", ".my_name", ".nano_time", ".random", ".time"}
)
"""Internal actions that take no time and do not fail."""
_ENDING: Final = frozenset(
    {".drop_all_desires", ".drop_all_events", ".drop_all_intentions", ".drop_desire", ".drop_event"}
    | {".drop_intention", ".fail_goal", ".kill_agent", ".succeed_goal", ".suspend"}
)
"""Internal actions by which another intention may end a loop."""

_Event = tuple[str, Signature]
"""Kind of an event (``!``, or empty for a belief), and what it is about."""
_HELP: Final = "wait in it, as in `.wait(1000)`, or end it with another plan"


def loops_without_wait(program: nodes.Program, found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of goals whose plans all post the goal again, and of ``while`` loops, if no step waits or acts.

    So is a plan that only posts its own goal again, until another one applies. Any other goal that has a plan without
    such a step, or that something else may end, is not reported.
    """
    if any(call.name in _ENDING or known.of(call).changes_plans for call in found.of(nodes.InternalAction)):
        return
    quick = _Quick(program, found, known)
    for loop in found.of(nodes.While):
        lasts = is_true(loop.condition) or (_asks_beliefs(loop.condition) and not _changes(loop.body))
        if lasts and quick.are(loop.body.steps):
            yield _without_wait("this loop", loop)
    reposts = _reposts(quick.plans, quick)
    seen: set[_Event] = _ended(found)
    for own, plans in quick.plans.items():
        for plan in plans if own not in seen and own not in reposts else ():
            if not _takes_all(plan) or ByKind(plan.body).of(nodes.BeliefChange):
                continue
            again = quick.raising(plan, quick.plans)
            if any(isinstance(each, nodes.Achieve) and each.goal == plan.trigger.literal for each in again):
                yield _without_wait(f"`!{own[1][1]}`", again[-1])
    event: _Event | None
    for event in reposts:
        path: list[_Event] = []
        while event is not None and event not in seen and event not in path:
            path.append(event)
            event = _event_of(reposts[event])
        if event is not None and event in path:
            kind, (_, name, _) = event
            yield _without_wait(f"`{kind or '+'}{name}`", reposts[path[-1]])
        seen.update(path)


def _without_wait(what: str, node: nodes.Step) -> Diagnostic:
    message = f"{what} repeats without end, and nothing in it waits or acts"
    return problem("loop-without-wait", message, node.span, _HELP)


def _by_event(plans: Iterable[nodes.Plan]) -> dict[_Event, list[nodes.Plan]]:
    found: dict[_Event, list[nodes.Plan]] = {}
    for plan in plans:
        if plan.trigger.operator == "+" and isinstance(plan.trigger.literal, nodes.Literal):
            found.setdefault((plan.trigger.kind, signature(plan.trigger.literal)), []).append(plan)
    return found


def _reposts(plans: Mapping[_Event, list[nodes.Plan]], quick: "_Quick") -> dict[_Event, nodes.Step]:
    """Return the events that always lead to one of them, each with the step that raises the next one."""
    raised = {
        event: [
            [(_event_of(step), step) for step in quick.raising(plan, plans)]
            for plan in sorted(of_event, key=lambda each: not _takes_all(each))
        ]
        for event, of_event in plans.items()
        if any(map(_takes_all, of_event))
    }
    shrinks = True
    while shrinks:
        shrinks = False
        for event, of_plans in reversed(list(raised.items())):  # most goals are posted before their plans
            raised[event] = [[each for each in steps if each[0] in raised] for steps in of_plans]
            if not all(raised[event]):
                del raised[event]
                shrinks = True
    return {event: of_plans[0][0][1] for event, of_plans in raised.items()}


def _takes_all(plan: nodes.Plan) -> bool:
    """Return whether a plan is applicable to every event of its name."""
    literal = plan.trigger.literal
    assert isinstance(literal, nodes.Literal)
    variables = all(isinstance(each, nodes.Variable) for each in literal.arguments)
    return is_true(plan.context) and variables and len(set(literal.arguments)) == len(literal.arguments)


def _event_of(step: nodes.Step) -> _Event | None:
    """Return the event that a step certainly raises."""
    if isinstance(step, nodes.Achieve) and isinstance(step.goal, nodes.Literal):
        return "!", signature(step.goal)
    if (
        isinstance(step, nodes.BeliefChange)
        and "+" in step.operator
        and isinstance(step.operand, nodes.Literal)
    ):
        # A belief that is there raises no event; one with another value does.
        return ("", signature(step.operand)) if ByKind(step.operand).of(nodes.Arithmetic) else None
    return None


def _ended(found: ByKind) -> set[_Event]:
    """Return the goals that something ends: an annotation, a goal condition or another branch; and their sub-goals."""
    ending = [goal for goal in found.of(nodes.Achieve) if annotations_of(goal.goal)]
    roots = [*ending, *found.of(nodes.Fork), *(each for each in found.of(nodes.Plan) if _has_end(each))]
    ended: set[_Event] = set()
    while roots:
        goals = {
            each for node in walk(*roots) if isinstance(node, nodes.Achieve) and (each := _event_of(node))
        }
        goals -= ended
        ended |= goals
        plans = found.of(nodes.Plan)
        roots = [each for each in plans if (each.trigger.kind, signature(each.trigger.literal)) in goals]
    return ended


def _has_end(plan: nodes.Plan) -> bool:
    return plan.goal_condition is not None or (
        isinstance(plan.label, nodes.Literal) and bool(annotations_of(plan.label))
    )


def _asks_beliefs(condition: nodes.Term) -> bool:
    return all(isinstance(part, nodes.Literal) and part.functor != "false" for part in parts_of(condition))


def _changes(body: nodes.Body) -> bool:
    return any(isinstance(node, nodes.BeliefChange | nodes.Achieve) for node in walk(body))


def _taken_away(body: nodes.Body) -> Iterator[nodes.Literal]:
    """Yield the beliefs that a body deletes and does not add again."""
    changes = [(each.operator, each.operand) for each in body.steps if isinstance(each, nodes.BeliefChange)]
    added = {
        signature(operand) for sign, operand in changes if "+" in sign and isinstance(operand, nodes.Literal)
    }
    for sign, operand in changes:
        if "+" not in sign and isinstance(operand, nodes.Literal) and signature(operand) not in added:
            yield operand


def _answers(fact: nodes.Literal, asked: nodes.Literal) -> bool:
    """Return whether a fact answers a query with variables in place of some of its arguments."""
    return signature(fact) == signature(asked) and all(
        isinstance(one, nodes.Variable) or one == other
        for one, other in zip(asked.arguments, fact.arguments, strict=True)
    )


class _Quick:
    """Tells the steps that take no time and do not fail."""

    def __init__(self, program: nodes.Program, found: ByKind, known: KnownActions) -> None:
        self._known = known
        self.plans = _by_event(program.plans)
        self._asked: dict[_Event, bool] = {}
        facts = [each for each in program.beliefs if isinstance(each, nodes.Literal)]
        gone = {signature(each) for body in found.of(nodes.Body) for each in _taken_away(body)}
        self._lasting = [each for each in facts if signature(each) not in gone]

    def raising(self, plan: nodes.Plan, plans: Mapping[_Event, object]) -> list[nodes.Step]:
        """Return the steps of a plan that raise events with plans and that only quick steps come before."""
        found: list[nodes.Step] = []
        for step in plan.body.steps if isinstance(plan.body, nodes.Body) and not plan.subplans else ():
            if _event_of(step) in plans:
                found.append(step)
            # A test with a value from elsewhere may fail.
            asks_value = isinstance(step, nodes.Test) and not set(
                names_in(plan.trigger, plan.context)
            ).isdisjoint(names_in(step))
            if asks_value or not self._is(step):
                break
        return found

    def are(self, steps: Iterable[nodes.Step]) -> bool:
        """Return whether all these steps are quick."""
        return all(map(self._is, steps))

    def _is(self, step: nodes.Step) -> bool:
        match step:
            case nodes.BeliefChange():
                return True
            case nodes.Constraint(nodes.InternalAction() as call):
                return self._known.of(call).prints or call.name in _PURE
            case nodes.Constraint(nodes.Relation("=", nodes.Variable())):
                return True
            case nodes.Test(nodes.Literal() as asked):
                return any(_answers(fact, asked) for fact in self._lasting)
            case nodes.If(_, then, otherwise):
                return self.are(then.steps) and (otherwise is None or self.are(otherwise.steps))
            case nodes.For(_, body):
                return self.are(body.steps)
            case nodes.Achieve(nodes.Literal() as goal, separate):
                return separate or self._ends(("!", signature(goal)))
        return False

    def _ends(self, event: _Event) -> bool:
        """Return whether a goal is achieved by quick steps."""
        if event not in self._asked:
            self._asked[event] = False  # while it is looked at: a recursion
            plans = self.plans.get(event, ())
            self._asked[event] = any(map(_takes_all, plans)) and all(
                isinstance(plan.body, nodes.Body) and self.are(plan.body.steps) for plan in plans
            )
        return self._asked[event]
