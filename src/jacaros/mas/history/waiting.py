"""What an intention waits for, in words."""

from jacaros.agents.mind.actions.goals import TIME
from jacaros.agents.mind.state.pending import (
    ASK,
    GOAL_CONDITION,
    CoroutineWait,
    Listener,
    Waiting,
    Watch,
    is_action,
)
from jacaros.agents.terms.values import Term, annotations_of
from jacaros.mas.history.words import shown


def waits_for(waiting: Waiting) -> str:
    """Return what ends a wait."""
    if waiting.act is not None:
        return _act(waiting)
    if isinstance(waiting, CoroutineWait):
        return f"the Python coroutine {shown(waiting.reason)}"
    if waiting.reason in (ASK, GOAL_CONDITION):
        return "an answer" if waiting.reason is ASK else "the condition of its goal"
    kinds = {type(each) for each in waiting.pending}
    what = "the event " if Listener in kinds else "the condition " if Watch in kinds else ""
    return f"{what}{shown(_awaited(waiting))}" if what else _time(waiting)


def _awaited(waiting: Waiting) -> Term:
    """Return the subject of a ``.wait``. See `jacaros.agents.mind.actions.goals`."""
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
