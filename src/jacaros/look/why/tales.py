"""What happened in a run, folded into tales: events of one kind are one tale with their number.

So twelve hours of patrol and one failure are two tales. `Rank` orders them by what matters first.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Literal, NamedTuple

from jacaros.look.records.records import Data, is_well_formed
from jacaros.look.records.words import cut
from jacaros.look.why.about_now import ending_step
from jacaros.look.why.chains import shown
from jacaros.look.why.explanation import seconds
from jacaros.look.why.past import AT_ONCE, Past
from jacaros.look.why.patterns import name_of

MOST_NAMES = 3
"""Maximum number of agents, robots or goals that a line names."""
MOST_PURSUITS = 3
"""Number of goals, those that were pursued longest, that come before faults and failures that a plan handled."""
LASTING = 1.0
"""Seconds from which on a goal is more than setup."""
LONG = 5.0
"""Seconds from which on a robot that is wrong about its pose, or an agent without a goal, is worth a line."""
LONGEST = 160
"""Maximum number of characters of a reason."""

_SIGNALS = 128
"""Exit codes from here on mean that a signal ended the run, such as that of Ctrl+C (130)."""

Level = Literal["error", "warning", "note"]


class Rank(IntEnum):
    """What matters first: tales of a lower rank stay when there are too many."""

    END = 0
    LOSS = 1
    PURSUIT = 2
    FAULT = 3
    TROUBLE = 4
    HANDLED = 5
    ROUTINE = 6


@dataclass(frozen=True, slots=True)
class StoryLine:
    """A line of a story.

    Attributes:
        t: seconds since the run began; of several events, of the first one.
        text: what happened, and to whom.
        level: ``error``, ``warning`` or ``note``.
        count, until: number of the events that are folded into this line, and the time of the last one.
        agent, robot: what it concerns, if that is one.
    """

    t: float
    text: str
    level: Level
    count: int = 1
    until: float | None = None
    agent: str = ""
    robot: str = ""


@dataclass
class Tale:
    """Events of one kind.

    Attributes:
        goals, states: of a pursuit, its goals, and how they ended.
        lasts: whether it lasts from the first event to the last one.
    """

    rank: Rank
    t: float
    text: str
    level: Level = "note"
    robot: str = ""
    lasts: bool = False
    count: int = 1
    last: float = 0.0
    who: dict[str, None] = field(default_factory=dict)
    goals: dict[str, None] = field(default_factory=dict)
    states: set[str] = field(default_factory=set)

    @property
    def weight(self) -> tuple[Rank, float]:
        """What matters first has the least: of failures the first one, otherwise what lasted longest."""
        return self.rank, self.t if self.level != "note" else self.t - self.last

    def line(self) -> StoryLine:
        """Return it as a line of the story."""
        text = self._pursuit() if self.goals else self.text
        text = f"{_names([*self.who])}: {text}" if self.who else text
        has_end = (self.count > 1 or self.lasts) and self.last > self.t
        until = round(self.last, 3) if has_end else None
        count = self.count if self.count > len(self.who) and not self.goals else 1
        single = next(iter(self.who)) if len(self.who) == 1 else ""
        agent, robot = ("", single) if self.robot else (single, "")
        return StoryLine(round(self.t, 3), text, self.level, count, until, agent, robot)

    def _pursuit(self) -> str:
        """Return what was pursued in words; rounds of a loop by their name, because they differ in their arguments."""
        verb = "achieved" if self.states == {"achieved"} else "pursued"
        goal = shown(next(iter(self.goals)))
        if len(self.goals) > 1:
            goal = f"!{name_of(goal)}"
        rounds = f", {self.count} rounds" if self.count > len(self.who) else ""
        return f"{verb} `{goal}`{rounds}"


@dataclass
class _Intention:
    """An open intention.

    Attributes:
        goals: its goals by number, the root goal first.
        tale: that of its root goal.
        failed: goals that failed together by number, the inner ones first, at *failed_at* because of *why*.
        is_suspended: whether its root goal is.
    """

    goals: dict[Any, str] = field(default_factory=dict)
    tale: Tale | None = None
    failed: dict[Any, str] = field(default_factory=dict)
    failed_at: float = 0.0
    why: str = ""
    is_suspended: bool = False

    @property
    def wanted(self) -> str:
        """Its root goal."""
        mark = " (suspended)" if self.is_suspended else ""
        return f"`{shown(next(iter(self.goals.values())))}`{mark}"


class Teller:
    """Takes the records of a run and folds them into tales."""

    def __init__(self) -> None:
        self._tales: dict[tuple[str, str], Tale] = {}
        self._open: dict[str, dict[Any, _Intention]] = {}
        """The open intentions of each agent."""
        self._idle: dict[str, float] = {}
        """Since when agents without an intention have none."""
        self._dropped: list[tuple[float, str, str]] = []
        self._warnings: list[tuple[float, Data]] = []

    def take(self, t: float, event: str, data: Data) -> None:
        """Take the next record."""
        is_other = event == "property" and data.get("name") != "question"
        if is_other or event not in _TAKEN or not is_well_formed(event, data):
            return
        match event:
            case "goal":
                self._goal(t, data)
            case "intention" if data["state"] == "over":
                self._close(t, data["agent"], data["id"])
            case "intention":
                self._open.setdefault(data["agent"], {}).setdefault(data["id"], _Intention())
            case "agent":
                self._agent(t, data["agent"], data["state"])
            case "log":
                self._warnings += [(t, data)] if data["level"] in ("warning", "error") else []
            case _:
                self._happening(t, event, data)

    def tales(self, past: Past, is_over: bool = True) -> list[Tale]:
        """Return all tales; *past* has the programs, and how the run ended."""
        for agent, key, intention in self._intentions():
            if intention.failed:
                self._close(intention.failed_at, agent, key)
            elif intention.tale is not None:
                intention.tale.last = past.end
                intention.tale.states.add("open")
        self._tell_warnings()
        pursuits = [each for each in self._tales.values() if each.goals]
        pursuits.sort(key=lambda each: each.weight)
        for each in pursuits[:MOST_PURSUITS]:
            each.rank = Rank.PURSUIT
        setup = [each for each in pursuits[1:] if each.last - each.t < LASTING]
        return [*(each for each in self._tales.values() if each not in setup), self._end(past, is_over)]

    def _tell(self, kind: str, t: float, text: str, who: str = "", robot: str = "", about: str = "") -> Tale:
        """Add to the tale of a kind and a text, or *about* in its place."""
        rank, level, _, lasts = _KINDS[kind]
        known = self._tales.get((kind, about or text))
        if known is None:
            known = Tale(rank, t, text, level, robot, lasts, count=0)
            self._tales[kind, about or text] = known
        known.count += 1
        known.last = t
        if who or robot:
            known.who[who or robot] = None
        return known

    # ---- goals

    def _intentions(self) -> Iterator[tuple[str, Any, _Intention]]:
        for agent, found in self._open.items():
            for key, intention in [*found.items()]:
                yield agent, key, intention

    def _goal(self, t: float, data: Data) -> None:
        state, goal, number, agent = data["state"], data["goal"], data.get("id"), data["agent"]
        key = data.get("intention") or f"goal {number}"
        mine = self._open.get(agent, {}).get(key)
        if mine is not None and mine.failed and (state != "failed" or t > mine.failed_at):
            # A goal with a plan for its failure is pursued again.
            if number in mine.failed and state in ("pursued", "recovered"):
                self._tell_failure(agent, mine, "handled")
            else:
                self._close(mine.failed_at, agent, key)
                mine = None
        if mine is None and state in ("pursued", "failed"):
            mine = self._open.setdefault(agent, {}).setdefault(key, _Intention())
        if mine is None:
            return
        if state == "failed":
            mine.failed[number] = goal
            mine.failed_at, mine.why = t, mine.why or data.get("why") or ""
        elif state == "pursued":
            if mine.tale is None:
                mine.tale = self._tell("goal", t, "", agent, about=name_of(goal))
                mine.tale.goals[goal] = None
            mine.goals[number] = goal
        elif number == next(iter(mine.goals), None):
            mine.is_suspended = state == "suspended" or (mine.is_suspended and state == "dropped")
            if state == "dropped":
                self._dropped.append((t, agent, mine.wanted))
            if state not in ("suspended", "resumed"):
                self._close(t, agent, key, state)
        elif state not in ("suspended", "resumed"):
            mine.goals.pop(number, None)

    def _close(self, t: float, agent: str, key: Any, state: str = "") -> None:
        mine = self._open.get(agent, {}).pop(key, None)
        if mine is None:
            return
        if mine.failed:
            self._tell_failure(agent, mine, "lost")
        if mine.tale is not None:
            mine.tale.last = t
            mine.tale.states.update({state} - {"replaced"})
        if not self._open[agent]:
            self._idle[agent] = t

    def _tell_failure(self, agent: str, failed: _Intention, kind: Literal["handled", "lost"]) -> None:
        because, goal = reason(failed.why), [*failed.failed.values()][-1]
        told = f"`{cut(shown(goal), LONGEST)}` failed{f': {because}' if because else ''}"
        # Consecutive goals that fail for one reason, and are handled, are one tale.
        about = _pattern(because) if kind == "handled" else f"{name_of(goal)} {_pattern(because)}"
        told += "; a plan handled it" if kind == "handled" else ""
        self._tell(kind, failed.failed_at, told, agent, about=about)
        failed.failed, failed.why = {}, ""

    # ---- the rest of the run

    def _tell_warnings(self) -> None:
        """Tell the warnings that no failed goal has told."""
        lost = [tale for key, tale in self._tales.items() if key[0] == "lost"]
        for t, data in self._warnings:
            found = _WARNING.match(data["text"])
            is_loss = found is not None and _LOST in data["text"]
            if is_loss and any(each.t - AT_ONCE <= t <= each.last + AT_ONCE for each in lost):
                continue
            who, text = (found[1], found[2]) if found is not None else ("", data["text"].partition("\n")[0])
            if is_loss:
                text = f"{text.partition(_LOST)[0]}: {reason(text)}"
            level = "error" if is_loss else data["level"]
            self._tell(level, t, cut(text, LONGEST), who, about=_pattern(text))

    def _agent(self, t: float, agent: str, state: str) -> None:
        if state == "ended":
            for key in [*self._open.get(agent, ())]:
                self._close(t, agent, key, "dropped")
            self._idle.pop(agent, None)
        else:
            self._idle.setdefault(agent, t)

    def _happening(self, t: float, event: str, data: Data) -> None:
        """Tell what happened to a robot, the fleet or the run."""
        text, robot = _KINDS[event].text.format_map(data), str(data.get("robot") or "")
        match event:
            case "member":
                if data["state"] == "lost":
                    self._tell(event, t, text, data["member"], about=data["member"])
            case "fault":
                text = text.replace("_", " ")
                tale = self._tales.get((event, text))
                if data["state"] not in ("ends", "acts"):
                    self._tell(event, t, text, robot=robot)
                elif tale is not None and data["state"] == "ends":
                    tale.last = t
                elif tale is not None and tale.count == 1 and t > tale.t:
                    tale.text = f"{text}, with an effect from {seconds(t)}"
            case "believed":  # repeated while it is wrong, then once without a pose
                if data.get("x") is not None:
                    tale = self._tell(event, t, text, robot=robot)
                    tale.count = 1
                    if tale.last - tale.t >= LONG:
                        tale.rank, tale.level = Rank.TROUBLE, "warning"
            case "property":  # the values of a question are its number, its text and the options
                if len(data["values"] or ()) > 1:
                    self._tell(event, t, f"{text}{cut(str(data['values'][1]), LONGEST)}")
            case _:
                self._tell(event, t, text, robot=robot)

    # ---- the end

    def _end(self, past: Past, is_over: bool) -> Tale:
        code, step = past.exit_code, ending_step(past)
        because = f", because {step.agent} ran {step.text}" if step is not None else ""
        parts = [f"the run ended with exit code {code}{because}"]
        cut_off = code is None and is_over
        if code is None:
            parts = ["the recording stops before the end of the run" if is_over else "the run continues"]
        elif code >= _SIGNALS:
            parts = [f"the run was stopped by signal {code - _SIGNALS}"]
        lost = {name for key, tale in self._tales.items() if key[0] == "lost" for name in tale.who}
        silent = {each: past.end - t for each, t in self._idle.items() if not self._open.get(each)}
        quiet = [each for each, passed in silent.items() if passed >= (AT_ONCE if each in lost else LONG)]
        lost.intersection_update(quiet)
        # The end of the run takes goals from agents.
        wanted = [(agent, goal) for t, agent, goal in self._dropped if past.end - t <= AT_ONCE]
        wanted += [(agent, each.wanted) for agent, _, each in self._intentions() if each.goals]
        if idle := [each for each in quiet if each in lost] or (quiet if not wanted else []):
            since = min(silent[each] for each in idle)
            parts.append(f"{_names(idle)} had no goal for the last {_duration(since)}")
        if wanted:
            agents = len({agent for agent, _ in wanted})
            by = f" by {agents} agents" if agents > 1 else ""
            what = "still wanted" if is_over else "pursued"
            parts.append(f"{what}{by}: {_names(sorted({goal for _, goal in wanted}))}")
        level: Level = "error" if lost or 0 < (code or 0) < _SIGNALS else "note"
        is_stuck = is_over and wanted and all(goal.endswith("(suspended)") for _, goal in wanted)
        if cut_off or (is_stuck and level == "note"):
            level = "warning"
        return Tale(Rank.END, past.end, "; ".join(parts), level)


class _Kind(NamedTuple):
    """A kind of tales; *text* is that of a record that needs nothing else.

    *lasts*: whether it lasts from the first event to the last one.
    """

    rank: Rank
    level: Level
    text: str = ""
    lasts: bool = False


_KINDS: Mapping[str, _Kind] = {
    "goal": _Kind(Rank.ROUTINE, "note", lasts=True),
    "handled": _Kind(Rank.HANDLED, "warning"),
    "lost": _Kind(Rank.LOSS, "error"),
    "warning": _Kind(Rank.TROUBLE, "warning"),
    "error": _Kind(Rank.LOSS, "error"),
    "member": _Kind(Rank.FAULT, "error", "did not answer; it is a system of the fleet"),
    "fault": _Kind(Rank.FAULT, "warning", "fault `{fault}` ({kind})", lasts=True),
    "believed": _Kind(Rank.ROUTINE, "note", "was not where it believed to be", lasts=True),
    "property": _Kind(Rank.FAULT, "warning", "a person was asked: "),
    "intervention": _Kind(Rank.FAULT, "note", "you changed the run: {what}"),
    "battery_empty": _Kind(Rank.LOSS, "error", "the battery is empty"),
    "fell": _Kind(Rank.LOSS, "error", "fell down a cliff"),
    "bump": _Kind(Rank.TROUBLE, "warning", "bumped into a wall, {side}"),
    "collision": _Kind(Rank.TROUBLE, "warning", "collided with {with}, {side}"),
    "command_timeout": _Kind(Rank.TROUBLE, "warning", "stopped, because no commands arrived"),
    "charged": _Kind(Rank.ROUTINE, "note", "charged its battery"),
    "task": _Kind(Rank.ROUTINE, "note", "did {task}"),
}

_TAKEN = {each for each, kind in _KINDS.items() if kind.text} | {"goal", "intention", "agent", "log"}
"""Records that tales are made of."""

_LOST = " failed and has no plan for its failure"
_WARNING = re.compile(r"\[([^\]]+)\] (?:warning: |error: )?(.*)")
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_NOISE = re.compile(
    rf"^.*{_LOST}: |^\w+, (?=\S)|^(?:action|operation) \S+ .*?(?:was aborted|failed)(?: with code -?\d+)?: "
)
_PLACE = re.compile(r" \(\S+:\d+\)$")


def reason(why: str) -> str:
    """Return why a goal failed in its shortest words: without the name of the error, the action and the place."""
    words = _PLACE.sub("", why.partition("\n")[0])
    for _ in range(3):  # each may be behind another
        words = _NOISE.sub("", words)
    return cut(words, LONGEST)


def _pattern(text: str) -> str:
    return _NUMBER.sub("#", text)


def _names(names: Iterable[str]) -> str:
    first = [*names]
    more = f" and {len(first) - MOST_NAMES} more" if len(first) > MOST_NAMES else ""
    return ", ".join(first[:MOST_NAMES]) + more


def _duration(t: float) -> str:
    if t < 120:
        return f"{t:.0f} s"
    return f"{t / 60:.0f} min" if t < 7200 else f"{t / 3600:.1f} h"
