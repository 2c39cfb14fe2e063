"""Answers about what agents wait for, and why nothing happens."""

from collections.abc import Iterator
from itertools import islice

from jacaros.mas.history.chains import chain, shown, source_line
from jacaros.mas.history.explanation import Explanation, Fact, seconds
from jacaros.mas.history.past import Data, Past

MOST_GOALS = 5
"""Maximum number of goals of a stack in an answer."""
MOST_INTENTIONS = 20
"""Maximum number of intentions in an answer."""


def explain_waiting(past: Past, question: str, agent: str = "") -> Explanation:
    """Explain what each intention waits for."""
    facts = tuple(_intentions(past, agent))
    waiting = sum(data.get("state") != "runs" for (name, _), (_, data) in _open(past, agent))
    who = agent or "all agents"
    if not facts:
        return Explanation(question, f"no intention of {who} is open at {seconds(past.end)}", past.end)
    answer = f"{waiting} of {len(facts)} intentions of {who} wait at {seconds(past.end)}"
    return Explanation(question, answer, past.end, facts[:MOST_INTENTIONS])


def _open(past: Past, agent: str) -> list[tuple[tuple[str, object], tuple[float, Data]]]:
    return [each for each in past.intentions.items() if agent in ("", each[0][0])]


def _intentions(past: Past, agent: str) -> Iterator[Fact]:
    for (name, number), (t, data) in _open(past, agent):
        stack = list(data.get("stack") or ())
        top = stack[-1] if stack else {}
        file, line = str(top.get("file") or ""), int(top.get("line") or 0)
        step = str(top.get("step") or "") or source_line(past, file, line)
        goals = " > ".join(_short([shown(each.get("goal", "")) for each in stack]))
        since = data.get("since")
        time = t if since is None else float(since)
        told = f"intention {number}{f', {goals},' if goals else ''} {_state(data)} since {seconds(time)}"
        yield Fact("intention", f"{told}{f', in `{step}`' if step else ''}", time, name, file, line)


def _short(goals: list[str]) -> list[str]:
    """Shorten a deep stack to its first and last goals."""
    return goals if len(goals) <= MOST_GOALS else [*goals[:2], "...", *goals[-2:]]


def _state(data: Data) -> str:
    state = data.get("state")
    if state == "runs":
        return "runs"
    if state == "suspended":
        reason = data.get("reason")
        return f"is suspended{f': {reason},' if reason else ''}"
    waits = str(data.get("waits") or "").removeprefix("for ")
    return f"waits for {waits}" if waits else "waits"


def explain_idleness(past: Past, question: str, agent: str = "") -> Explanation:
    """Explain why nothing happens: the run has ended or is paused, goals were lost, or everything waits."""
    last = _last_event(past, agent)
    facts = [
        *_ends(past, agent),
        *_lost(past, agent),
        *islice(_intentions(past, agent), MOST_INTENTIONS),
        *_silence(past, last),
    ]
    because = () if last is None else chain(past, last[1]["id"])
    return Explanation(question, _why_idle(past, agent, last), past.end, tuple(facts), because)


def _why_idle(past: Past, agent: str, last: tuple[float, Data] | None) -> str:
    if past.exit_code is not None:
        return f"the run ended at {seconds(past.end)} with exit code {past.exit_code}"
    if past.debug.get("state") == "paused":
        return f"the run is paused: {past.debug.get('why') or 'on request'}"
    running = [each for each in _open(past, agent) if each[1][1].get("state") == "runs"]
    if running:
        return f"the run is active: {len(running)} intentions run at {seconds(past.end)}"
    if _open(past, agent):
        return f"every open intention of {agent or 'all agents'} waits at {seconds(past.end)}"
    when = "" if last is None else f"; the last event was `{shown(last[1]['trigger'])}` at {seconds(last[0])}"
    who = f"{agent} has neither a goal nor" if agent else "no agent has a goal or"
    return f"{who} an event at {seconds(past.end)}{when}"


def _last_event(past: Past, agent: str) -> tuple[float, Data] | None:
    return next((each for each in reversed(past.deliberations) if agent in ("", each[1]["agent"])), None)


def _ends(past: Past, agent: str) -> Iterator[Fact]:
    for name, (t, state) in past.agents.items():
        if state == "ended" and agent in ("", name):
            yield Fact("note", f"ended at {seconds(t)}", t, name)


def _lost(past: Past, agent: str) -> Iterator[Fact]:
    """Return the last failure of each agent that was not recovered."""
    lost: dict[object, tuple[float, Data]] = {}
    for t, data in past.goals:
        if data.get("state") == "failed":
            lost[data.get("agent"), data.get("id")] = t, data
        else:
            lost.pop((data.get("agent"), data.get("id")), None)
    newest = {data["agent"]: (t, data) for t, data in lost.values() if agent in ("", data.get("agent"))}
    for name, (t, data) in newest.items():
        why = f": {data['why']}" if data.get("why") else ""
        yield Fact("goal", f"{data['goal']} failed at {seconds(t)}{why}", t, name)


def _silence(past: Past, last: tuple[float, Data] | None) -> Iterator[Fact]:
    """Return the last event, if no plan was chosen for it."""
    if last is not None and last[1].get("chosen") is None:
        yield Fact(
            "event",
            f"the last event `{shown(last[1]['trigger'])}` had no applicable plan",
            last[0],
            last[1]["agent"],
        )
