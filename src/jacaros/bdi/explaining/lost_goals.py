"""Describe goals that failed and that no plan handled: where, at which step, for which goals, and why."""

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

from jacaros.asl.formatter import format_term
from jacaros.asl.source import Span
from jacaros.bdi.explaining.failing_context import FailingContexts, short
from jacaros.bdi.explaining.failure_reason import FailureReason, shown_goal
from jacaros.bdi.explaining.step_text import unbracketed
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import GOAL, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.excerpt import excerpt
from jacaros.terms.text import text
from jacaros.terms.values import functor, functor_of

ENV_FAILURE_REASON, ENV_FAILURE_DETAIL = functor("env_failure_reason", 1), functor("env_failure_detail", 1)

MOST_GOALS = 6
"""Maximum number of goals listed of a deeper stack, those next to the failure."""
MOST_PLANS = 3
"""Maximum number of unfit plans listed."""
LONGEST_MESSAGE = 600
"""Maximum number of characters of an ``error_msg`` shown; plans get all of it."""


class Loss(NamedTuple):
    """The description of a lost goal.

    Attributes:
        told: the first line: what failed, with what error, and where.
        details: further lines: the step and the goals it served, plans that did not fit, reason terms for plans.
        span: the place in the program, None if it is unknown.
    """

    told: str
    details: tuple[str, ...]
    span: Span | None

    def text(self) -> str:
        """Return the whole text; details are indented."""
        return "\n  ".join((self.told, *self.details))


def loss(agent: Circumstance, intention: Intention, reason: FailureReason, goal: Goal | None) -> Loss:
    """Describe an intention without a plan for its failure.

    Args:
        agent: the agent of the intention.
        intention: with the stack as it was.
        reason: of the failure.
        goal: the goal that failed, if it is not on the stack.
    """
    stack = note_goals(agent, intention, reason, goal)
    wanted = next((each for each in reversed(stack) if each[0].operator == "+" and each[0].kind), None)
    if wanted is not None:
        what = f"the goal {short(shown_goal(wanted))}"
    else:
        what = f"the plan for {reason.goals[-1]}" if reason.goals else "an intention"
    return loss_of(what, reason)


def note_goals(
    agent: Circumstance, intention: Intention, reason: FailureReason, goal: Goal | None
) -> list[Goal]:
    """Record with a reason the goals on the stack and the agent's plans, before they change.

    Returns:
        the goals that failed with the step, the inner ones first.
    """
    stack = [*reason.place.inner_goals, *([] if goal is None else [goal]), *goals_below(intention)]
    reason.goals = _shown(stack)
    unplanned = reason.place.unplanned
    reason.candidates = () if unplanned is None else _candidates(agent, *unplanned)
    return stack


def loss_of(what: str, reason: FailureReason) -> Loss:
    """Describe *what*, such as ``the goal !go``, whose goals were recorded in the reason."""
    told = f"{what} failed and has no plan for its failure{_why(reason)}{_place(reason)}"
    return Loss(told, details(reason, what), reason.place.span())


def lost_in_handler(
    agent: Circumstance, intention: Intention, goal: Goal, reason: FailureReason | None
) -> Loss:
    """Describe a failure event whose plans do not fit."""
    told = f"no applicable plan for the failure event {shown_goal(goal)}; the intention is dropped"
    if reason is None:
        return Loss(told, (), None)
    reason.goals = _shown(list(goals_below(intention)))
    reason.candidates = _candidates(agent, goal, reason)
    return Loss(f"{told}{_why(reason)}{_place(reason)}", details(reason), reason.place.span())


def inapplicable(agent: Circumstance, event: Goal, annotations: EventAnnotations) -> Loss:
    """Describe an event whose plans are not applicable."""
    return Loss(f"no applicable plan for {shown_goal(event)}", _candidates(agent, event, annotations), None)


def lost_question(asker: str, goal: Goal, reason: FailureReason) -> Loss | None:
    """Describe a question from *asker* whose plan failed; its goals were recorded in the reason.

    Return None if no plan was applicable: that is an answer, for example of a plan whose context checks the asker.
    """
    unplanned = reason.place.unplanned
    if unplanned is not None and unplanned[0] is goal:
        return None
    told = f"the question {shown_goal(goal)} from {asker} is answered false, because its plan failed"
    return Loss(
        f"{told}{_why(reason)}{_place(reason)}", details(reason, f"the question {shown_goal(goal)}"), None
    )


def why(reason: FailureReason) -> str:
    """Describe a reason for records of a run, in lines: error, message and place; the step; plans that did not fit, once
    recorded; the terms for plans.
    """
    step = _step(reason)
    return "\n".join(
        (
            f"{_error(reason)}{_place(reason)}",
            *([f"step: {step}"] if step else ()),
            *reason.candidates,
            *_terms(reason),
        )
    )


def details(reason: FailureReason, what: str = "") -> tuple[str, ...]:
    """Return the lines after message and place; *what*, such as ``the goal !go``, has already been named."""
    goals = [short(goal) for goal in reason.goals]
    if len(goals) == 1 and what.endswith(f" {goals[0]}"):
        goals = []
    lines = []
    step = _step(reason)
    if step:
        lines.append(f"step: {step}{', for ' if goals else ''}{', '.join(goals)}")
    elif len(goals) > 2:  # the message names the first and the last
        lines.append(f"for: {', '.join(goals[1:])}")
    return (*lines, *reason.candidates, *_terms(reason))


def _step(reason: FailureReason) -> str:
    step = reason.place.step()
    # The reason that it passes on is in the other lines.
    return ".fail(...)" if step.startswith(".fail(") else short(step)


def _terms(reason: FailureReason) -> list[str]:
    """Return the line with the annotations that plans can ask for.

    CArtAgO's reason is left out if it contains only the action itself and another term says more.
    """
    terms = reason.others()
    if any(functor_of(term) is ENV_FAILURE_DETAIL for term in terms):
        terms = [term for term in terms if functor_of(term) is not ENV_FAILURE_REASON]
    return [f"reason: {', '.join(short(text(excerpt(term))) for term in terms)}"] if terms else []


def goals_below(intention: Intention) -> Iterator[Goal]:
    """Yield the goals on the stack of an intention, the top one first; for a handler the failure event that it handles."""
    frames = intention.frames
    handlers = len(intention.handlers)
    index = len(frames) - 1
    while index >= 0:
        goal = frames[index][GOAL]
        if goal[0].functor.namespace != "jacaros":
            yield goal
        if goal[0].failing:
            handlers -= 1
            index = intention.handlers[handlers]
        index -= 1


def _shown(stack: list[Goal]) -> tuple[str, ...]:
    """Return goals as text; of a stack of thousands only the first and the last."""
    left = len(stack) - MOST_GOALS
    if left <= 1:
        return tuple(map(shown_goal, stack))
    return (*map(shown_goal, stack[: MOST_GOALS - 1]), f"{left} more", shown_goal(stack[-1]))


def _why(reason: FailureReason) -> str:
    told = _error(reason)
    return f": {told}" if told else ""


def _error(reason: FailureReason) -> str:
    return ", ".join(filter(None, (reason.known_error(), short(reason.message(), LONGEST_MESSAGE))))


def _place(reason: FailureReason) -> str:
    where = reason.place.where()
    return f" ({where})" if where else ""


def _candidates(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> tuple[str, ...]:
    """Return the plans for a goal, those whose trigger fits first, each with the conjunct at which its context stops."""
    plans = agent.library.relevant(goal[0])
    contexts = FailingContexts(agent, goal, annotations)
    shown = list(islice(filter(contexts.fits, plans), MOST_PLANS))
    shown += islice((plan for plan in plans if plan not in shown), MOST_PLANS - len(shown))
    lines = [_candidate(plan, contexts.stop(plan)) for plan in shown]
    left = len(plans) - len(shown)
    return (*lines, f"and {left} more plans") if left > 0 else tuple(lines)


def _candidate(plan: Plan, stop: str) -> str:
    """Describe a plan that did not fit: trigger, place and the conjunct at which its context stops, or its context."""
    node = plan.node
    trigger = node.trigger
    told = f"{trigger.operator}{trigger.kind}{format_term(trigger.literal)}"
    if node.context is not None and not stop:
        told += f" : {unbracketed(format_term(node.context))}"
    line = f":{node.span.line}" if node.span is not None else ""
    return f"does not fit: {short(told)} ({plan.file}{line}){', ' if stop else ''}{stop}"
