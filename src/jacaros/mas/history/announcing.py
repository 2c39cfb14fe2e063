"""Explanations during a run: whenever an event of interest is handled or a goal of interest fails, and at the end of
the run for events that never happened.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from jacaros.mas.history.about_events import explain_deliberation, explain_event
from jacaros.mas.history.explanation import Explanation, seconds
from jacaros.mas.history.history import History
from jacaros.mas.history.past import Past
from jacaros.mas.history.patterns import Pattern, name_of


class Announcer:
    """Explains events as they are handled.

    Args:
        history: history of the run. The caller starts its observation.
        events: events of interest, such as ``+alarm(_)`` or ``!go(dock)``.
        tell: takes each explanation as text.

    Raises:
        UsageError: one of them is not an event, a goal or a belief.
    """

    def __init__(self, history: History, events: Sequence[str], tell: Callable[[str], None]) -> None:
        self._history, self._tell = history, tell
        self._wanted = {event: Pattern(event) for event in events}
        self._unmet = dict.fromkeys(events)

    def begin(self) -> None:
        """Explain from now on."""
        self._history.listen(self._hear)

    def _hear(self, t: float, event: str, data: Mapping[str, Any]) -> None:
        read = _READERS.get(event)
        if read is None:
            if event == "ended":
                self._explain_unmet()
            return
        happened = read(data)
        for asked, pattern in self._wanted.items():
            if happened and pattern.fits(happened):
                explanation = self._explain(asked, t, event, data)
                if explanation is not None:
                    self._unmet.pop(asked, None)
                    self._tell(explanation.text())

    def _explain_unmet(self) -> None:
        past = Past.of(self._history.all())
        for asked in self._unmet:
            self._tell(explain_event(past, asked, asked, "").text())

    def _explain(self, asked: str, t: float, event: str, data: Mapping[str, Any]) -> Explanation | None:
        past = Past.of(self._history.all())
        if event == "deliberation":
            return explain_deliberation(past, asked, t, data)
        if event == "belief":
            return None if _has_plan(past, data) else explain_event(past, asked, asked, data["agent"])
        why = f": {data['why']}" if data.get("why") else ""
        return Explanation(asked, f"{data['agent']}: {data['goal']} failed at {seconds(t)}{why}", t)


_READERS: Mapping[str, Callable[[Mapping[str, Any]], str]] = {
    "deliberation": lambda data: str(data["trigger"]),
    "belief": lambda data: f"{data['op']}{data['belief']}",
    "goal": lambda data: str(data["goal"]) if data["state"] == "failed" else "",
}
"""Functions that return the trigger of an explained event, by kind of record."""


def _has_plan(past: Past, change: Mapping[str, Any]) -> bool:
    """Return whether a plan may handle a belief change. Then the event is explained when it is handled."""
    name = name_of(str(change["belief"]))
    triggers = (str(plan.get("trigger", "")) for _, plan in past.plans(str(change["agent"])))
    return any(each.startswith(change["op"]) and name_of(each) in (name, "") for each in triggers)
