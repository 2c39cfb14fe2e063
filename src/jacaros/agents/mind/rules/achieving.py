"""Goals and plans that are checked: what they were to achieve is tested when the plan ends.

``achieves(Condition, Ms)`` of a goal, or of the label of a plan. The plan stays on the stack until its condition holds, for
at most Ms milliseconds, and then ends as achieved, or fails like a plan whose last step fails. A plan that handled the
failure of the goal is not tested: what it does is the program's answer.
"""

import re
from collections.abc import Iterator

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.mind.rules import failure, meta_events
from jacaros.agents.mind.rules.failure_reason import ERROR, ERROR_MSG, FailureReason, Place, unbracketed
from jacaros.agents.mind.rules.pending import is_true, now, set_alarm, watch
from jacaros.agents.mind.rules.supervision import end
from jacaros.agents.mind.state.belief_base import literal, parts
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import GOAL, PLAN, STEP, Frame, Intention, Posted, variables_of
from jacaros.agents.mind.state.pending import (
    CONDITION,
    SUPERVISION,
    Supervision,
    Waiting,
    holders_below,
    is_supervision,
)
from jacaros.agents.mind.state.plan import ACHIEVES, SUSPENDED, Rule
from jacaros.agents.mind.state.triggers import own_annotations, trigger
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import rename, resolve
from jacaros.agents.terms.text import display
from jacaros.agents.terms.values import (
    LOGIC,
    PLAIN,
    Functor,
    String,
    Term,
    arguments_of,
    atom,
    deref,
    functor,
    functor_of,
    make_list,
    structure,
)

_SETTLING = functor(ACHIEVES, 1)
_AND = functor("&", 2, kind=LOGIC)
_UNNAMED = re.compile(r"\b_\d+\b")
_MOST_FOUND = 12
"""Maximum number of beliefs in ``found(..)``."""


def is_achieved(agent: Circumstance, intention: Intention) -> bool:
    """Test what the plan on top, which has ended, was to achieve.

    If that does not hold, the intention waits for it, or the next step of the frame makes the plan fail.
    """
    frame = intention.frames[-1]
    for holder in untested(intention, len(intention.frames) - 1):
        condition, seconds = _condition(holder, frame)
        held, fault = is_true(agent, condition)
        if held and fault is None:
            holder[CONDITION] = None
            continue
        log_fault(agent, fault, condition)
        if fault is None and seconds > 0:
            _settle(agent, intention, holder, condition, seconds)
        else:
            frame[STEP] = fail_unachieved
        return False
    return True


def untested(intention: Intention, index: int) -> Iterator[Frame]:
    """Yield the supervisions of the plan at *index*, and of its goal, whose conditions have not held yet."""
    frame = intention.frames[index]
    if not is_supervision(frame):
        for holder in holders_below(intention, index):
            of_goal = holder[SUPERVISION].kind is not None
            if holder[CONDITION] is not None and not (of_goal and frame[GOAL][0].failing):
                yield holder


def _condition(holder: Frame, frame: Frame) -> tuple[Term, float]:
    """Return what a goal or plan was to achieve, with the present values, and for how many seconds to wait for it."""
    supervision: Supervision = holder[SUPERVISION]
    if supervision.kind is not None:
        return holder[CONDITION], supervision.settle
    names = Variables(variables_of(frame))
    return both(
        [lower(each, names.__getitem__) for each in node.arguments]
        for node in frame[PLAN].guards
        if node.functor == ACHIEVES
    )


def both(given: Iterator[list[Term]] | list[list[Term]]) -> tuple[Term, float]:
    """Join the arguments of annotations ``achieves(Condition, Ms)``; an invalid time does not count."""
    condition, seconds = None, 0.0
    for wanted, *times in given:
        condition = wanted if condition is None else (_AND, condition, wanted)
        seconds = max(seconds, *(time / 1000 for time in map(resolve, times) if time.__class__ is float), 0.0)
    return condition, seconds


def _settle(
    agent: Circumstance, intention: Intention, holder: Frame, condition: Term, seconds: float
) -> None:
    """Wait until the condition holds, or the time is over."""
    frame = intention.frames[-1]
    waiting = Waiting(intention, (_SETTLING, condition), began=now(agent))
    waiting.attach(frame, frame[STEP])
    waiting.pending.append(watch(agent, condition, _settled, waiting, holder))
    waiting.pending.append(set_alarm(agent, seconds, _unsettled, waiting))
    if agent.features.meta and frame[STEP] is None:  # otherwise the rule that made the step reports it
        meta_events.top_goal_state(agent, intention, "waiting", waiting.reason)


def is_settling(intention: Intention, frame: Frame) -> bool:
    """Return whether the plan of a frame has ended, and its condition may come true yet."""
    waiting = intention.waiting
    return waiting is not None and waiting.frame is frame and functor_of(waiting.reason) is _SETTLING


def _settled(agent: Circumstance, fault: Exception | None, waiting: Waiting, holder: Frame) -> None:
    log_fault(agent, fault, waiting.reason[1])
    if fault is None:
        holder[CONDITION] = None
        agent.end_wait(waiting)
    else:
        _unsettled(agent, waiting)


def _unsettled(agent: Circumstance, waiting: Waiting) -> None:
    waiting.next_step = fail_unachieved
    agent.end_wait(waiting)


def log_fault(agent: Circumstance, fault: Exception | None, condition: Term) -> None:
    """Log that a condition cannot be evaluated."""
    if fault is not None:
        told = f"cannot evaluate the condition {display(_shown(condition))}: {failure.told(fault)}"
        agent.architecture.log("error", told)


def _shown(condition: Term) -> Term:
    """Return a condition with its values, for plans and logs."""
    try:
        return rename(resolve(condition))
    except (ArithmeticFault, RecursionError):
        return String("without value")


# --- failure -----------------------------------------------------------------------------------------------


def fail_unachieved(agent: Circumstance, frame: Frame) -> object:
    """The step behind the last one of a plan that has not achieved what it was to achieve: it fails."""
    intention = agent.current
    assert intention is not None
    holder = next(untested(intention, len(intention.frames) - 1))
    condition = _condition(holder, frame)[0]
    shown = _shown(condition)
    wanted = _UNNAMED.sub("_", unbracketed(display(shown)))
    message = f"{wanted} does not hold when the plan has ended"
    terms = (
        (ERROR, atom("not_achieved")),
        (ERROR_MSG, String(message)),
        structure("not_achieved", shown),
        structure("found", make_list(_found(agent, condition))),
    )
    reason = FailureReason(terms, Place(frame))
    if holder[SUPERVISION].kind is None:
        posted = clean_up(agent, intention, holder[SUPERVISION], frame, reason)
    else:
        posted = failure.fail_intention(agent, intention, reason)
    return posted or SUSPENDED


def _found(agent: Circumstance, condition: Term) -> list[Term]:
    """Return the beliefs with the names that a condition asks for, also in rules, the newest of each name first."""
    asked = list(_asked(condition))
    found: list[Term] = []
    for symbol in asked:  # becomes longer meanwhile
        for entry, _ in agent.beliefs[symbol].entries() if symbol in agent.beliefs else ():
            if isinstance(entry, tuple):
                found.append(literal(symbol, entry))
            elif isinstance(entry, Rule):
                asked.extend(each for each in dict.fromkeys(_named(entry.node.body)) if each not in asked)
    return found[:_MOST_FOUND]


def _asked(condition: Term) -> dict[Functor, None]:
    asked: dict[Functor, None] = {}
    terms = [condition]
    while terms:
        term = deref(terms.pop())
        symbol = functor_of(term)
        if symbol is not None and symbol.kind == LOGIC:
            terms.extend(reversed(arguments_of(term)))
        elif symbol is not None and symbol.kind == PLAIN:
            asked.setdefault(symbol)
    return asked


def _named(body: nodes.Node) -> Iterator[Functor]:
    for part in nodes.nodes_in(nodes.Literal, body):
        if isinstance(part.namespace, str | None):
            yield functor(part.functor, len(part.arguments), part.negated, part.namespace)


def clean_up(
    agent: Circumstance, intention: Intention, supervision: Supervision, frame: Frame, reason: FailureReason
) -> Posted | None:
    """Post the clean-up goal of a plan, after which the plan fails; without one it fails immediately."""
    end(agent, supervision)
    symbol = functor_of(supervision.cleanup)
    if symbol is None or symbol.kind:
        return failure.fail_intention(agent, intention, reason)
    supervision.lost, frame[STEP] = reason, fail_lost
    _, arguments, annotations = parts(supervision.cleanup)
    return Posted((trigger("+", "!", symbol), *arguments), own_annotations(annotations))


def fail_lost(agent: Circumstance, frame: Frame) -> object:
    """The step after the clean-up goal of a plan: the plan fails."""
    del frame
    intention = agent.current
    assert intention is not None
    supervision: Supervision = intention.frames[-2][SUPERVISION]
    reason, supervision.lost = supervision.lost, None
    return failure.fail_intention(agent, intention, reason) or SUSPENDED
