"""What an intention waits for, in words."""

from collections.abc import Callable

from jacaros.bdi.actions.waiting import TIME
from jacaros.bdi.state.condition_waits import ConditionWait
from jacaros.bdi.state.waiting import (
    ActWait,
    AnswerWait,
    CoroutineWait,
    EventWait,
    GoalConditionWait,
    TimedWait,
    Waiting,
    is_action,
)
from jacaros.mas.history.words import shown
from jacaros.terms.values import Term, annotations_of


def waits_for(waiting: Waiting) -> str:
    """Return what ends a wait."""
    return next((told(waiting) for kind, told in _WORDS if isinstance(waiting, kind)), shown(waiting.reason))


def _awaited(waiting: Waiting) -> Term:
    """Return the subject of a ``.wait``. See `jacaros.bdi.actions.waiting`."""
    found = annotations_of(waiting.reason)
    return found[0] if found else waiting.reason


def _time(waiting: Waiting) -> str:
    awaited = _awaited(waiting)
    if awaited.__class__ is tuple and awaited[0] is TIME and isinstance(awaited[1], float):
        return f"{awaited[1] / 1000:g} s"
    return shown(awaited)


def _act(waiting: Waiting) -> str:
    reason = waiting.reason
    if reason.__class__ is tuple and not is_action(reason):  # needs(wheels)
        return f"the resource{'s' if len(reason) > 2 else ''} {', '.join(map(shown, reason[1:]))}"
    return f"the action {shown(reason[1] if reason.__class__ is tuple else reason)}"


_WORDS: tuple[tuple[type[Waiting], Callable[[Waiting], str]], ...] = (
    (ActWait, _act),
    (EventWait, lambda waiting: f"the event {shown(_awaited(waiting))}"),
    (ConditionWait, lambda waiting: f"the condition {shown(_awaited(waiting))}"),
    (TimedWait, _time),
    (AnswerWait, lambda waiting: "an answer"),
    (GoalConditionWait, lambda waiting: "the condition of its goal"),
    (CoroutineWait, lambda waiting: f"the Python coroutine {shown(waiting.reason)}"),
)
