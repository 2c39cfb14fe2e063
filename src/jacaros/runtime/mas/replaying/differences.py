"""Where two runs of an agent decided differently: the same events, other plans."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from jacaros.look.records.records import DeliberationRecord, PlanRecord, Record
from jacaros.look.why.about_events import candidates
from jacaros.look.why.chains import is_written, place_of, plan_name, plan_text, shown
from jacaros.look.why.explanation import Fact, seconds
from jacaros.look.why.past import Past, TimedRecords

MOST_EVENTS = 5
"""Number of events of one run only that the text lists."""


@dataclass(frozen=True, slots=True)
class Decision:
    """An event that two runs handled differently.

    Attributes:
        t: seconds since the recorded run began.
        event: as text, such as ``+battery(25)``.
        then, now: the plan in the recording and in the rerun; None if none was applicable.
        reasons: the plans that the rerun considered before, with the part of the context that failed.
    """

    t: float
    event: str
    then: Fact | None
    now: Fact | None
    reasons: tuple[Fact, ...]

    def text(self) -> str:
        """Return the decision as lines."""
        lines = [
            f"{seconds(self.t)}  {self.event}",
            f"  then: {_told(self.then)}",
            f"  now:  {_told(self.now)}",
        ]
        return "\n".join((*lines, *(f"        {each.written()}" for each in self.reasons)))


@dataclass(frozen=True, slots=True)
class Comparison:
    """The decisions of a recorded agent compared with those of a changed program.

    Attributes:
        agent: name of the agent.
        same: number of events that both handled with the same plan.
        decisions: events that they handled differently, the oldest first.
        only_then, only_now: events of one run only, as text with their times.
        waiting: actions of the rerun whose end was not recorded.
        unreadable: number of inputs that were truncated in the recording and ignored.
    """

    agent: str
    same: int
    decisions: tuple[Decision, ...]
    only_then: tuple[str, ...]
    only_now: tuple[str, ...]
    waiting: tuple[str, ...]
    unreadable: int

    def text(self) -> str:
        """Return the comparison as lines."""
        count = len(self.decisions)
        times = "once" if count == 1 else f"{count} times"
        told = f"{self.agent} decides {f'differently {times}' if count else 'as before'}"
        lines = [f"{told}; {self.same} decisions are the same"]
        lines += [each.text() for each in self.decisions]
        lines += _listed("events only then", self.only_then)
        lines += _listed("events only now", self.only_now)
        lines += _listed("actions that wait, because their end was not recorded", self.waiting)
        if self.unreadable:
            lines.append(
                f"percepts and messages ignored, because they are truncated in the recording: {self.unreadable}"
            )
        return "\n".join(lines)

    def data(self) -> dict[str, Any]:
        """Return the comparison as JSON data."""
        return asdict(self)


def compare(
    then: Iterable[Record],
    now: Iterable[Record],
    agent: str,
    waiting: Sequence[str] = (),
    unreadable: int = 0,
) -> Comparison:
    """Compare the decisions of an agent in two runs: the first event with a text with the first one in the other run,
    and so on.
    """
    old, new = Past.of(then), Past.of(now)
    identity = _Identity(old, new, agent)
    before, after = _by_event(old, agent), _by_event(new, agent)
    decisions: list[Decision] = []
    same = 0
    for event, handled in before.items():
        for (t, was), (_, is_now) in zip(handled, after[event], strict=False):
            if identity.is_same(was.chosen, is_now.chosen):
                same += 1
            else:
                decisions.append(_decision(old, new, t, event, was, is_now))
    decisions.sort(key=lambda each: each.t)
    only_then, only_now = _rest(before, after), _rest(after, before)
    return Comparison(agent, same, tuple(decisions), only_then, only_now, tuple(waiting), unreadable)


def _by_event(past: Past, agent: str) -> dict[str, TimedRecords[DeliberationRecord]]:
    found: dict[str, TimedRecords[DeliberationRecord]] = defaultdict(list)
    for t, data in past.deliberations:
        if data.agent == agent:
            found[shown(data.trigger)].append((t, data))
    return found


def _rest(
    first: dict[str, TimedRecords[DeliberationRecord]], other: dict[str, TimedRecords[DeliberationRecord]]
) -> tuple[str, ...]:
    """Return the events that only the first run has, the oldest first."""
    left = [(t, event) for event, handled in first.items() for t, _ in handled[len(other.get(event, ())) :]]
    return tuple(f"{event} at {seconds(t)}" for t, event in sorted(left))


def _decision(
    old: Past, new: Past, t: float, event: str, was: DeliberationRecord, is_now: DeliberationRecord
) -> Decision:
    then, now = (_chosen(past, data) for past, data in ((old, was), (new, is_now)))
    reasons = tuple(
        each for each in candidates(new, is_now) if not each.text.endswith((": chosen", "before it"))
    )
    return Decision(t, event, then, now, reasons)


def _chosen(past: Past, deliberation: DeliberationRecord) -> Fact | None:
    plan = past.plan(deliberation.agent, deliberation.chosen)
    return Fact("plan", plan_name(plan), None, "", *place_of(plan)) if plan else None


class _Identity:
    """Which plans of two programs are the same: those with one label; or else with one trigger, in the same order if there
    are equally many, or with the same context."""

    def __init__(self, old: Past, new: Past, agent: str) -> None:
        then, now = old.programs.get(agent, {}), new.programs.get(agent, {})
        before, after = (Counter(map(_trigger, plans.values())) for plans in (then, now))
        ordered = {trigger for trigger, count in before.items() if after[trigger] == count}
        self._then, self._now = dict(_names(then, ordered)), dict(_names(now, ordered))

    def is_same(self, then: Any, now: Any) -> bool:
        """Return whether a plan of the first program is one of the second; None equals only None."""
        return self._then.get(then) == self._now.get(now)


def _names(plans: dict[Any, PlanRecord], ordered: set[str]) -> Iterator[tuple[Any, tuple[str, str]]]:
    seen: Counter[str] = Counter()
    for number, plan in plans.items():
        trigger, label = _trigger(plan), plan.label or ""
        seen[trigger] += 1
        if is_written(label):
            yield number, ("label", label)
        elif trigger in ordered:
            yield number, (trigger, str(seen[trigger]))
        else:
            yield number, ("text", plan_text(plan))


def _trigger(plan: PlanRecord) -> str:
    """Return the kind of event that a plan is for: name and arguments without values."""
    return shown(plan.trigger).partition("(")[0]


def _told(plan: Fact | None) -> str:
    return "no applicable plan" if plan is None else plan.written()


def _listed(what: str, events: Sequence[str]) -> list[str]:
    if not events:
        return []
    more = f" and {len(events) - MOST_EVENTS} more" if len(events) > MOST_EVENTS else ""
    return [f"{what}: {', '.join(events[:MOST_EVENTS])}{more}"]
